#include <algorithm>
#include <iterator>
#include <span>
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
    // Lists depend on the places, too: room for more pairs than a jet ever has, or for all there
    // are. What is never written takes no memory.
    const std::size_t clusters = tree_.clusters().size(), leaves = tree_.leaves().size();
    const std::size_t far = std::min(clusters * (clusters + 1) / 2, 32 * clusters);
    const std::size_t near = std::min(leaves * (leaves + 1) / 2, 32 * leaves);
    if (lists_.size() < threads) lists_.resize(threads);
    for (Lists& lists : lists_) lists.far.reserve(far), lists.near.reserve(near);
    far_.reserve(far), near_.reserve(near);
    sweeps_.reserve(std::min(near, 8 * leaves));
    first_.reserve(leaves + 1);
  }
  [[nodiscard]] double* local(std::size_t thread, std::size_t cluster) {
    return locals_.data() + set_ * (tree_.clusters().size() * thread + cluster);
  }

  /// Pairs of clusters that act by their expansions, and of leaves that act charge by charge. A
  /// cluster and itself is a pair, too.
  struct Lists {
    std::vector<Pair> far, near;
  };

  void plan(std::size_t thread, std::size_t team) override {
#pragma omp single
    share_out(team);
    Lists& lists = lists_[thread];
    if (thread > 0)
      lists.far.clear(), lists.near.clear(); // the first has what was known before
    for (std::size_t k = thread; k < open_.size(); k += team) visit(open_[k], lists);
#pragma omp barrier
#pragma omp single
    {
      far_.clear();
      for (std::size_t t = 0; t < team; ++t)
        far_.insert(far_.end(), lists_[t].far.begin(), lists_[t].far.end());
      merge_near(team);
    }
  }

  // The top of the traversal, until there are enough pairs for all threads to be about equally
  // busy.
  void share_out(std::size_t team) {
    constexpr std::size_t pairs_per_thread = 256;
    Lists& lists = lists_[0];
    lists.far.clear(), lists.near.clear();
    open_.assign(1, {0, 0});
    while (team > 1 && !open_.empty() && open_.size() < pairs_per_thread * team) {
      opened_.clear();
      for (const Pair& pair : open_)
        open(pair, lists, [this](const Pair& next) { opened_.push_back(next); });
      open_.swap(opened_);
    }
  }

  void visit(const Pair& pair, Lists& lists) {
    open(pair, lists, [&](const Pair& next) { visit(next, lists); });
  }

  /// Lists a pair, or hands on the pairs that it is made of. The first cluster is not behind the
  /// second.
  template <class Next>
  void open(const Pair& pair, Lists& lists, const Next& next) {
    const auto [a, b] = pair;
    const Cluster &c = tree_.clusters()[a], &d = tree_.clusters()[b];
    if (a == b) {
      if (c.is_leaf()) {
        lists.near.push_back(pair);
        return;
      }
      next({c.child, c.child}), next({c.child + 1, c.child + 1});
      next({c.child, c.child + 1});
    } else if (accepted(c, d, true)) {
      lists.far.push_back(pair);
    } else if (c.is_leaf() && d.is_leaf()) {
      lists.near.push_back(pair);
    } else if (d.is_leaf() || (!c.is_leaf() && c.radius > d.radius)) {
      next({c.child, b}), next({c.child + 1, b});
    } else {
      next({a, d.child}), next({a, d.child + 1});
    }
  }

  // A leaf's near leaves mostly follow each other: one sweep of the kernel over all of them, which
  // pays for the loading and the adding up of its targets once.
  void merge_near(std::size_t team) {
    const auto rank = [this](std::uint32_t leaf) {
      return tree_.clusters()[leaf].begin / parameters_.leaf;
    };
    first_.assign(tree_.leaves().size() + 1, 0); // of each leaf's entries, by counting
    const std::span<const Lists> lists(lists_.data(), team);
    for (const Lists& l : lists)
      for (const Pair& pair : l.near) ++first_[rank(pair.first) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    near_.resize(first_.back());
    for (const Lists& l : lists)
      for (const Pair& pair : l.near) near_[first_[rank(pair.first)]++] = pair;

    sweeps_.clear();
    std::size_t cost = 0;
    for (std::size_t k = 0; k < near_.size();) {
      std::size_t end = k;
      while (end < near_.size() && near_[end].first == near_[k].first) ++end;
      // Few, and nearly in order: the number of a leaf grows along the jet within a level.
      std::ranges::sort(near_.begin() + static_cast<std::ptrdiff_t>(k),
                        near_.begin() + static_cast<std::ptrdiff_t>(end), {},
                        [&](const Pair& pair) { return rank(pair.second); });
      const Cluster& a = tree_.clusters()[near_[k].first];
      for (; k < end; ++k) {
        const Cluster& b = tree_.clusters()[near_[k].second];
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
    // Shares of equal cost. The sweeps of one leaf stay together: they report close pairs in the
    // same places.
    const auto at_cost = [&](std::size_t cost) {
      auto s = std::ranges::lower_bound(sweeps_, cost, {}, &Sweep::cost_so_far);
      while (s != sweeps_.begin() && s != sweeps_.end()
             && s->rows.first == std::prev(s)->rows.first)
        ++s;
      return s;
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
    for (std::size_t level = 0; level + 1 < tree_.levels().size(); ++level)
      shift_level(level, locals_.data(), Shift::downward);
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
  std::vector<Lists> lists_;        ///< of each thread
  std::vector<Pair> open_, opened_; ///< pairs that are yet to be visited
  std::vector<Pair> far_, near_;    ///< of all threads; near pairs by their first leaf
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
