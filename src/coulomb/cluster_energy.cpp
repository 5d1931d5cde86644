#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <vector>

#include "clusters.hpp"
#include "solvers.hpp"

namespace ehdjet::detail {
namespace {

struct EnergyProblem {
  const ClusterParameters& parameters;
  const Expansions& expansions;
  const ScaledCharges& charges;
  const ClusterTree& tree;
  const Multipoles& multipoles;
  double closest = closest_of(parameters.order);

  /// The energy of the charges of a leaf in the potential of a cluster.
  [[nodiscard]] double energy_of(std::uint32_t leaf, std::uint32_t source) const {
    const Cluster &target = tree.clusters()[leaf], &cluster = tree.clusters()[source];
    const ChargeColumns c = charges.columns();
    const double d = between(cluster.centre, target.centre).norm(),
                 to_target = d - target.radius, theta = cluster.radius / to_target;
    if (cluster.radius + closest + round_off_of(d) < parameters.opening * to_target
        && power(theta, parameters.order + 1) <= (1 - theta) * parameters.tolerance)
      return ExpansionKernel::unit
             * expansions.kernel.energy_in_multipole(expansions.numbers, c, target.begin,
                                                     target.end, cluster.centre,
                                                     multipoles[source]);
    if (!cluster.is_leaf())
      return energy_of(leaf, cluster.child) + energy_of(leaf, cluster.child + 1);
    const std::size_t length = charges.length();
    const ConstVec3View r{{c.x, length}, {c.y, length}, {c.z, length}};
    double sum = 0;
    for (std::size_t i = target.begin; i < tree.end_of(target); ++i)
      sum += c.q[i]
             * potential_sum(r[i], r, {c.q, length}, cluster.begin, tree.end_of(cluster));
    return sum;
  }
};

} // namespace

double cluster_energy(const Kernels& kernels, const ClusterParameters& parameters,
                      ConstVec3View r, std::span<const double> q) {
  EHDJET_EXPECTS(r.x.size() == q.size() && r.y.size() == q.size()
                 && r.z.size() == q.size());
  if (q.empty()) return 0;
  const int threads = threads_for(q.size());
  const PointCharges group{r, q, {}};
  ScaledCharges charges;
  charges.load({&group, 1}, 1);
  Clusters clusters;
  clusters.find(charges, 0, parameters.leaf);
  const Expansions expansions(kernels.expansions, parameters.order);
  Multipoles multipoles(expansions);
  multipoles.reserve(clusters.tree);
  const EnergyProblem problem{parameters, expansions, charges, clusters.tree, multipoles};
  const auto leaves = clusters.tree.leaves();
  std::vector<double> energies(leaves.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    multipoles.gather(clusters.tree, charges.columns());
#pragma omp for schedule(dynamic, 4)
    for (std::size_t i = 0; i < leaves.size(); ++i)
      energies[i] = problem.energy_of(leaves[i], 0);
  }
  CompensatedSum sum;
  for (const double e : energies) sum += e;
  return charges.energy(sum / 2); // each pair has been counted twice
}

} // namespace ehdjet::detail
