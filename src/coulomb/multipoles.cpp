#include "multipoles.hpp"

#include <algorithm>
#include <array>

namespace ehdjet::detail {

// An unused lane reads zeros and writes to a set that is never read.
ExpansionKernel::Batch idle_batch() {
  alignas(64) static const std::array<double, coefficients(highest_order) + padding> zero{};
  alignas(64) thread_local std::array<double, coefficients(highest_order) + padding>
      nowhere{};
  ExpansionKernel::Batch batch{};
  for (std::size_t lane = 0; lane < ExpansionKernel::most_lanes; ++lane) {
    for (std::size_t side = 0; side < 2; ++side)
      batch.from[side][lane] = zero.data(), batch.to[side][lane] = nowhere.data();
    batch.dz[lane] = 1;
  }
  return batch;
}

void shift_level(const Expansions& expansions, const ClusterTree& tree, std::size_t level,
                 double* sets, Shift direction) {
  const ExpansionKernel& kernel = expansions.kernel;
  const auto clusters = tree.clusters();
  const std::size_t begin = tree.levels()[level], end = tree.levels()[level + 1];
  const std::size_t parents = kernel.lanes / 2; // per batch
#pragma omp for schedule(static)
  for (std::size_t first = begin; first < end; first += parents) {
    ExpansionKernel::Batch batch = idle_batch();
    for (std::size_t k = 0; k < parents && first + k < end; ++k) {
      const Cluster& parent = clusters[first + k];
      if (parent.is_leaf()) continue;
      double* own = sets + expansions.set * (first + k);
      if (direction == Shift::upward) std::fill_n(own, expansions.set, 0.0);
      for (std::size_t c = 0; c < 2; ++c) {
        const Cluster& child = clusters[parent.child + c];
        double* childs = sets + expansions.set * (parent.child + c);
        if (direction == Shift::upward)
          set_lane(batch, 2 * k + c, childs, own, between(child.centre, parent.centre));
        else
          set_lane(batch, 2 * k + c, own, childs, between(parent.centre, child.centre));
      }
    }
    (direction == Shift::upward ? kernel.shift_multipoles
                                : kernel.shift_locals)(expansions.numbers, batch);
  }
}

void Multipoles::gather(const ClusterTree& tree, const ChargeColumns& charges) {
  const auto clusters = tree.clusters();
  const auto leaves = tree.leaves();
#pragma omp for schedule(static)
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Cluster& leaf = clusters[leaves[i]];
    expansions_.kernel.charges_to_multipole(expansions_.numbers, charges, leaf.begin,
                                            tree.end_of(leaf), leaf.centre,
                                            sets_[expansions_.lines * leaves[i]].value);
  }
  for (std::size_t level = tree.levels().size() - 1; level-- > 0;)
    shift_level(expansions_, tree, level, sets_.data()->value, Shift::upward);
}

// The power of degree l, sqrt(sum_m |M_l^m|^2), is at most Q r^l, which is reached by charges in two
// places at the ends of the cluster. For a straight piece of a curve it is Q r^l/(l+1), for a ring a
// third of Q r^l. The acceptance criterion is calibrated for these two, with even orders for straight
// pieces only, because of their larger share of the tolerance (cluster_solver.cpp). The last two
// degrees are used, because every other degree of a symmetric cluster vanishes. What two degrees say of
// a cluster with a dense core at its edge is too little.
void Multipoles::weigh(ClusterTree& tree, bool uneven) const {
  const int p = expansions_.numbers.order;
  const bool even = p % 2 == 0;
  const double smooth = even ? std::max(0.2, 1.0 / p) : 0.4;
  // The field of degree p is (p + 1) times its potential over r.
  const double most = (even ? 2 : 1) * (p + 1);
  const auto clusters = tree.clusters();
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    Cluster& c = clusters[k];
    c.lumped = 1;
    if (!(c.radius > 0 && c.charge > 0)) continue;
    if (uneven) {
      c.lumped = most;
      continue;
    }
    if (c.moving > 0 && c.moving < static_cast<double>(tree.end_of(c) - c.begin)) {
      c.lumped = most; // the charges that move may all be at one end
      continue;
    }
    const double* set = (*this)[k];
    double part = 0; // squared
    double most_power = c.charge * c.charge * power(c.radius * c.radius, p - 1);
    for (int l = p - 1; l <= p; ++l, most_power *= c.radius * c.radius) {
      double half = set[real_part(l, 0)] * set[real_part(l, 0)] / 2;
#pragma omp simd reduction(+ : half)
      for (std::size_t i = real_part(l, 1); i < real_part(l + 1, 0); ++i)
        half += set[i] * set[i];
      // For tiny radii the power underflows. Then the worst case is assumed.
      if (!(2 * half <= smooth * smooth * most_power) || most_power < 1e-290)
        part =
            std::max(part, most_power < 1e-290 ? 1 : std::min(1.0, 2 * half / most_power));
    }
    if (part == 0) continue;
    part = std::sqrt(part);
    c.lumped = 1 + (most - 1) * std::max(0.0, (part - smooth) / (1 - smooth));
  }
}

} // namespace ehdjet::detail
