#include "far_field.hpp"

namespace ehdjet::detail {
namespace {

/// Barnes-Hut treecode with multipoles. The field at the charges of a leaf is that of the multipoles
/// of distant clusters, plus that of the charges of near leaves. There are no local expansions and
/// no conflicts between threads.
///
/// cost   : O(n log n); memory: one coefficient set and its gradient per cluster
/// source : Barnes & Hut, Nature 324 (1986) 446
class Treecode final : public FarField {
public:
  [[nodiscard]] std::string_view name() const override { return "treecode"; }
  [[nodiscard]] bool met_coincident() const override { return coincident_ > 0; }
  [[nodiscard]] std::uint64_t near_pairs() const override { return near_pairs_; }

  void reserve(const ClusterProblem& p, std::size_t /*threads*/) override {
    gradient_size_ = 3 * coefficients(p.expansions.numbers.order + 1);
    const std::size_t numbers = gradient_size_ * p.sources.clusters().size();
    if (gradients_.size() < numbers) gradients_.resize(numbers);
    near_pairs_ = coincident_ = 0;
  }

  void act(const ClusterProblem& p, std::size_t /*thread*/, std::size_t /*team*/) override {
    const std::size_t clusters = p.sources.clusters().size();
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < clusters; ++k)
      p.expansions.kernel.multipole_gradient(p.expansions.numbers, p.multipoles[k],
                                             gradient(k));
    const auto leaves = p.targets.leaves();
    Counts counts;
    // Each thread gets a range of leaves, because all leaves cost about the same.
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < leaves.size(); ++i) feel(p, leaves[i], 0, counts);
#pragma omp critical
    near_pairs_ += counts.near, coincident_ += counts.coincident;
  }

private:
  struct Counts {
    std::uint64_t near = 0, coincident = 0;
  };
  [[nodiscard]] double* gradient(std::size_t cluster) {
    return gradients_.data() + gradient_size_ * cluster;
  }

  void feel(const ClusterProblem& p, std::uint32_t leaf, std::uint32_t source,
            Counts& counts) {
    const Cluster &target = p.targets.clusters()[leaf],
                  &cluster = p.sources.clusters()[source];
    const bool self = p.is_mutual() && leaf == source;
    if (!self && in_one_place(cluster, target)) {
      ++counts.coincident;
    } else if (p.acceptance.one_sided(cluster, target)) {
      p.expansions.kernel.multipole_to_charges(p.expansions.numbers, p.charges.columns(),
                                               p.charges.field(0), target.begin, target.end,
                                               cluster.centre, gradient(source));
    } else if (!cluster.is_leaf()) {
      feel(p, leaf, cluster.child, counts), feel(p, leaf, cluster.child + 1, counts);
    } else {
      const auto act = self ? p.pairs.add_fields : p.pairs.add_fields_one_way;
      act(p.charges.columns(), p.charges.field(0),
          {target.begin / p.pairs.targets, target.end / p.pairs.targets, 1, cluster.begin,
           cluster.end},
          p.charges.close());
      counts.near +=
          std::uint64_t{target.end - target.begin} * (cluster.end - cluster.begin);
    }
  }

  std::size_t gradient_size_ = 0;
  std::uint64_t near_pairs_ = 0, coincident_ = 0;
  std::vector<double> gradients_;
};

} // namespace

std::unique_ptr<FarField> make_treecode() {
  return std::make_unique<Treecode>();
}

} // namespace ehdjet::detail
