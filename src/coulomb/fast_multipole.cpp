#include <algorithm>
#include <utility>

#include "cluster_solver.hpp"

namespace ehdjet::detail {
namespace {

/// Mutual dual-tree traversal: both clusters of a pair act on each other, so that forces add up to
/// zero, to the rounding of the expansions.
///
/// cost   : O(n); memory: two coefficient sets per cluster, one more per further thread
/// source : Dehnen, Comput. Astrophys. Cosmol. 1 (2014) 1
class FastMultipole final : public ClusterSolver {
public:
  using ClusterSolver::ClusterSolver;
  [[nodiscard]] std::string_view name() const override { return "fmm"; }

private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  void reserve(std::size_t threads) override {
    const std::size_t numbers = set_ * tree_.clusters().size() * threads;
    if (locals_.size() < numbers) locals_.resize(numbers);
    // Lists depend on the places, too: room for more pairs than a jet ever has, or for all there are.
    const std::size_t clusters = tree_.clusters().size(), leaves = tree_.leaves().size();
    const std::size_t pairs_of_leaves = std::min(leaves * (leaves + 1) / 2, 32 * leaves);
    far_.reserve(std::min(clusters * (clusters + 1) / 2, 32 * clusters));
    near_.reserve(pairs_of_leaves), ordered_.reserve(pairs_of_leaves);
    sweeps_.reserve(std::min(pairs_of_leaves, 8 * leaves));
    first_.reserve(leaves + 1);
  }
  [[nodiscard]] double* local(std::size_t thread, std::size_t cluster) {
    return locals_.data() + set_ * (tree_.clusters().size() * thread + cluster);
  }

  void plan() override {
    far_.clear(), near_.clear();
    visit(0);
    merge_near();
  }

  // A leaf's near leaves mostly follow each other: one sweep of the kernel over all of them, which pays
  // for the loading and the adding up of its targets once.
  void merge_near() {
    const auto rank = [this](std::uint32_t leaf) {
      return tree_.clusters()[leaf].begin / parameters_.leaf;
    };
    first_.assign(tree_.leaves().size() + 1, 0); // of each leaf's entries, by counting
    for (const Pair& pair : near_) ++first_[rank(pair.first) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    ordered_.resize(near_.size());
    for (const Pair& pair : near_) ordered_[first_[rank(pair.first)]++] = pair;

    sweeps_.clear();
    std::size_t cost = 0;
    for (std::size_t k = 0; k < ordered_.size();) {
      std::size_t end = k;
      while (end < ordered_.size() && ordered_[end].first == ordered_[k].first) ++end;
      // Few, and nearly in order: the number of a leaf grows along the jet within a level of the tree.
      std::ranges::sort(ordered_.begin() + static_cast<std::ptrdiff_t>(k),
                        ordered_.begin() + static_cast<std::ptrdiff_t>(end), {},
                        [&](const Pair& pair) { return rank(pair.second); });
      const Cluster& a = tree_.clusters()[ordered_[k].first];
      for (; k < end; ++k) {
        const Cluster& b = tree_.clusters()[ordered_[k].second];
        const bool follows = !sweeps_.empty()
                             && sweeps_.back().rows.first == a.begin / pairs_.targets
                             && sweeps_.back().rows.end == b.begin;
        if (!follows)
          sweeps_.push_back(
              {{a.begin / pairs_.targets, a.end / pairs_.targets, 1, b.begin, b.end}, 0});
        cost += std::size_t{a.end - a.begin} * (b.end - b.begin);
        sweeps_.back().rows.end = b.end;
        sweeps_.back().cost_so_far = cost;
      }
    }
  }
  void visit(std::uint32_t a) {
    const Cluster& c = tree_.clusters()[a];
    if (c.is_leaf()) {
      near_.emplace_back(a, a);
      return;
    }
    visit(c.child), visit(c.child + 1);
    visit(c.child, c.child + 1);
  }
  void visit(std::uint32_t a, std::uint32_t b) { // a before b
    const Cluster &c = tree_.clusters()[a], &d = tree_.clusters()[b];
    if (accepted(c, d, true)) {
      far_.emplace_back(a, b);
    } else if (c.is_leaf() && d.is_leaf()) {
      near_.emplace_back(a, b);
    } else if (d.is_leaf() || (!c.is_leaf() && c.radius > d.radius)) {
      visit(c.child, b), visit(c.child + 1, b);
    } else {
      visit(a, d.child), visit(a, d.child + 1);
    }
  }

  void act(std::size_t thread, std::size_t team) override {
    std::fill_n(local(thread, 0), set_ * tree_.clusters().size(), 0.0);
    act_far(thread, team);
    act_near(thread, team);
#pragma omp barrier
    gather_locals(team);
  }

  void act_far(std::size_t thread, std::size_t team) {
    const auto clusters = tree_.clusters();
    const std::size_t lanes = kernel_.lanes, batches = (far_.size() + lanes - 1) / lanes;
    const std::size_t last = batches * (thread + 1) / team;
    for (std::size_t k = batches * thread / team; k < last; ++k) {
      ExpansionKernel::Batch batch = idle_batch();
      for (std::size_t lane = 0; lane < lanes && k * lanes + lane < far_.size(); ++lane) {
        const auto [a, b] = far_[k * lanes + lane];
        set_lane(batch, lane, multipole(a), local(thread, a),
                 between(clusters[a].centre, clusters[b].centre));
        batch.from[1][lane] = multipole(b), batch.to[1][lane] = local(thread, b);
      }
      kernel_.multipoles_to_locals(numbers_, batch);
    }
  }

  void act_near(std::size_t thread, std::size_t team) {
    const std::size_t total = sweeps_.empty() ? 0 : sweeps_.back().cost_so_far;
    const auto at_cost = [&](std::size_t cost) { // shares of equal cost
      return std::ranges::lower_bound(sweeps_, cost, {}, &Sweep::cost_so_far);
    };
    const auto end =
        thread + 1 == team ? sweeps_.end() : at_cost(total * (thread + 1) / team);
    for (auto s = at_cost(total * thread / team); s < end; ++s)
      pairs_.add_fields(charges_.columns(), charges_.field(thread), s->rows,
                        charges_.close());
  }

  // Sums of the threads' locals, children from their parents, charges from their leaves.
  void gather_locals(std::size_t team) {
    const auto clusters = tree_.clusters();
    const std::size_t numbers = set_ * clusters.size();
    if (team > 1) {
#pragma omp for schedule(static)
      for (std::size_t i = 0; i < numbers; ++i)
        for (std::size_t t = 1; t < team; ++t) locals_[i] += locals_[i + t * numbers];
    }
    const auto levels = tree_.levels();
    const std::size_t parents = kernel_.lanes / 2;
    for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
      const std::size_t begin = levels[level], end = levels[level + 1];
#pragma omp for schedule(static)
      for (std::size_t first = begin; first < end; first += parents) {
        ExpansionKernel::Batch batch = idle_batch();
        for (std::size_t k = 0; k < parents && first + k < end; ++k) {
          const Cluster& parent = clusters[first + k];
          if (parent.is_leaf()) continue;
          for (std::size_t c = 0; c < 2; ++c)
            set_lane(batch, 2 * k + c, local(0, first + k), local(0, parent.child + c),
                     between(parent.centre, clusters[parent.child + c].centre));
        }
        kernel_.shift_locals(numbers_, batch);
      }
    }
    const auto leaves = tree_.leaves();
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const Cluster& leaf = clusters[leaves[i]];
      kernel_.local_to_charges(numbers_, charges_.columns(), charges_.field(0), leaf.begin,
                               leaf.end, leaf.centre, local(0, leaves[i]));
    }
  }

  /// Charges of a leaf against those of leaves that follow each other.
  struct Sweep {
    TileRows rows;
    std::size_t cost_so_far; ///< pairs, up to and with this one
  };
  std::vector<Pair> far_, near_; ///< clusters by their expansions, leaves charge by charge
  std::vector<Pair> ordered_;
  std::vector<std::size_t> first_;
  std::vector<Sweep> sweeps_;
  std::vector<double> locals_;
};

} // namespace

std::unique_ptr<CoulombSolver> make_fast_multipole(const Kernels& kernels,
                                                   const ClusterParameters& parameters) {
  return std::make_unique<FastMultipole>(kernels, parameters);
}

} // namespace ehdjet::detail
