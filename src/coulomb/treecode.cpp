#include <algorithm>

#include "cluster_solver.hpp"

namespace ehdjet::detail {
namespace {

/// Barnes-Hut treecode with multipoles: each leaf's charges feel far clusters through their
/// multipoles, directly, and near leaves charge by charge. No local expansions, no conflicts
/// between threads.
///
/// cost   : O(n log n); memory: one coefficient set and its gradient per cluster
/// source : Barnes & Hut, Nature 324 (1986) 446
class Treecode final : public ClusterSolver {
public:
  using ClusterSolver::ClusterSolver;
  [[nodiscard]] std::string_view name() const override { return "treecode"; }

private:
  void reserve(std::size_t /*threads*/) override {
    gradient_size_ = 3 * coefficients(parameters_.order + 1);
    const std::size_t numbers = gradient_size_ * tree_.clusters().size();
    if (gradients_.size() < numbers) gradients_.resize(numbers);
  }
  void plan(std::size_t /*thread*/, std::size_t /*team*/) override {}

  void act(std::size_t /*thread*/, std::size_t /*team*/) override {
    const std::size_t clusters = tree_.clusters().size();
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < clusters; ++k)
      kernel_.multipole_gradient(numbers_, multipole(k), gradient(k));
    const auto leaves = tree_.leaves();
    // All leaves cost about the same, so that each thread may have its own range of them.
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < leaves.size(); ++i) feel(leaves[i], 0);
  }

  [[nodiscard]] double* gradient(std::size_t cluster) {
    return gradients_.data() + gradient_size_ * cluster;
  }

  void feel(std::uint32_t leaf, std::uint32_t source) {
    const Cluster &target = tree_.clusters()[leaf], &cluster = tree_.clusters()[source];
    if (accepted(cluster, target, false)) {
      kernel_.multipole_to_charges(numbers_, charges_.columns(), charges_.field(0),
                                   target.begin, target.end, cluster.centre,
                                   gradient(source));
    } else if (!cluster.is_leaf()) {
      feel(leaf, cluster.child), feel(leaf, cluster.child + 1);
    } else {
      const auto act = leaf == source ? pairs_.add_fields : pairs_.add_fields_one_way;
      act(charges_.columns(), charges_.field(0),
          {target.begin / pairs_.targets, target.end / pairs_.targets, 1, cluster.begin,
           cluster.end},
          charges_.close());
    }
  }

  std::size_t gradient_size_ = 0;
  std::vector<double> gradients_;
};

} // namespace

std::unique_ptr<CoulombSolver> make_treecode(const Kernels& kernels,
                                             const ClusterParameters& parameters) {
  return std::make_unique<Treecode>(kernels, parameters);
}

} // namespace ehdjet::detail
