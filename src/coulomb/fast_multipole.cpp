#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "far_field.hpp"

namespace ehdjet::detail {
namespace {

/// Mutual dual-tree traversal: both clusters of a pair act on each other. The sum of all forces is
/// therefore zero within the rounding of the expansions.
///
/// cost   : O(n); memory: two coefficient sets per cluster, one more per further thread
/// source : Dehnen, Comput. Astrophys. Cosmol. 1 (2014) 1
class FastMultipole final : public FarField {
public:
  [[nodiscard]] std::string_view name() const override { return "fmm"; }
  [[nodiscard]] bool met_coincident() const override { return met_coincident_; }
  [[nodiscard]] std::uint64_t near_pairs() const override {
    return sweeps_.empty() ? 0 : sweeps_.back().cost_so_far;
  }

  void reserve(const ClusterProblem& p, std::size_t threads) override {
    const std::size_t from = p.sources.clusters().size(), to = p.targets.clusters().size();
    const std::size_t lines = p.expansions.lines * to * threads;
    if (locals_.size() < lines) locals_.resize(lines);
    // The length of the lists depends on the positions. The reserve is larger than for any jet, or
    // the number of all pairs. Memory that is never written costs nothing.
    const auto room = [](std::size_t a, std::size_t b) {
      return std::min(a * (b + 1), 32 * std::max(a, b));
    };
    const std::size_t leaves = p.targets.leaves().size();
    const std::size_t far = room(from, to), near = room(p.sources.leaves().size(), leaves);
    if (lists_.size() < threads) lists_.resize(threads);
    for (Lists& lists : lists_) lists.far.reserve(far), lists.near.reserve(near);
    far_.reserve(far), near_.reserve(near);
    sweeps_.reserve(std::min(near, 8 * leaves));
    first_.reserve(leaves + 1);
  }

  void act(const ClusterProblem& p, std::size_t thread, std::size_t team) override {
    plan(p, thread, team);
    std::fill_n(local(p, thread, 0), p.expansions.set * p.targets.clusters().size(), 0.0);
    act_far(p, thread, team);
    act_near(p, thread, team);
#pragma omp barrier
    gather_locals(p, team);
  }

private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>; ///< target and source
  /// Pairs of clusters that act by their expansions (far), and pairs of leaves that act charge by
  /// charge (near). A leaf also forms a pair with itself.
  struct Lists {
    std::vector<Pair> far, near;
    bool coincident = false;
    void clear() { far.clear(), near.clear(), coincident = false; }
  };

  [[nodiscard]] double* local(const ClusterProblem& p, std::size_t thread,
                              std::size_t cluster) {
    return locals_[p.expansions.lines * (p.targets.clusters().size() * thread + cluster)]
        .value;
  }

  void plan(const ClusterProblem& p, std::size_t thread, std::size_t team) {
#pragma omp single
    share_out(p, team);
    Lists& lists = lists_[thread];
    if (thread > 0) lists.clear(); // share_out has filled the lists of thread 0
    for (std::size_t k = thread; k < open_.size(); k += team) visit(p, open_[k], lists);
#pragma omp barrier
#pragma omp single
    {
      far_.clear();
      met_coincident_ = false;
      for (std::size_t t = 0; t < team; ++t) {
        far_.insert(far_.end(), lists_[t].far.begin(), lists_[t].far.end());
        met_coincident_ = met_coincident_ || lists_[t].coincident;
      }
      merge_near(p, team);
    }
  }

  // The top of the traversal. It ends when there are enough pairs to share them evenly.
  void share_out(const ClusterProblem& p, std::size_t team) {
    constexpr std::size_t pairs_per_thread = 256;
    Lists& lists = lists_[0];
    lists.clear();
    open_.assign(1, {0, 0});
    while (team > 1 && !open_.empty() && open_.size() < pairs_per_thread * team) {
      opened_.clear();
      for (const Pair& pair : open_)
        open(p, pair, lists, [this](const Pair& next) { opened_.push_back(next); });
      open_.swap(opened_);
    }
  }

  void visit(const ClusterProblem& p, const Pair& pair, Lists& lists) {
    open(p, pair, lists, [&](const Pair& next) { visit(p, next, lists); });
  }

  /// Lists a pair, or calls `next` for the pairs into which it is split. If the charges act on each
  /// other, the first cluster never comes after the second.
  template <class Next>
  static void open(const ClusterProblem& p, const Pair& pair, Lists& lists,
                   const Next& next) {
    const auto [a, b] = pair;
    const Cluster &c = p.targets.clusters()[a], &d = p.sources.clusters()[b];
    const bool mutual = p.is_mutual();
    // Two cases are near pairs, but the order of the questions matters.
    if (mutual && a == b && c.is_leaf()) { // NOLINT(bugprone-branch-clone)
      lists.near.push_back(pair);
    } else if (in_one_place(c, d)) {
      lists.coincident = true;
    } else if (mutual && a == b) {
      next({c.child, c.child}), next({c.child + 1, c.child + 1});
      next({c.child, c.child + 1});
    } else if (p.acceptance.two_sided(d, c, mutual)) {
      lists.far.push_back(pair);
    } else if (c.is_leaf() && d.is_leaf()) {
      lists.near.push_back(pair);
    } else if (d.is_leaf() || (!c.is_leaf() && c.radius > d.radius)) {
      next({c.child, b}), next({c.child + 1, b});
    } else {
      next({a, d.child}), next({a, d.child + 1});
    }
  }

  // The near leaves of a leaf are mostly successive. One sweep of the kernel over all of them loads
  // the targets and adds up their fields only once.
  void merge_near(const ClusterProblem& p, std::size_t team) {
    const auto rank = [&p](const Pair& pair) { return p.targets.rank(pair.first); };
    first_.assign(p.targets.leaves().size() + 1, 0); // a counting sort by target leaves
    const std::span<const Lists> lists(lists_.data(), team);
    for (const Lists& l : lists)
      for (const Pair& pair : l.near) ++first_[rank(pair) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    near_.resize(first_.back());
    for (const Lists& l : lists)
      for (const Pair& pair : l.near) near_[first_[rank(pair)]++] = pair;

    sweeps_.clear();
    std::uint64_t cost = 0;
    for (std::size_t k = 0; k < near_.size();) {
      std::size_t end = k;
      while (end < near_.size() && near_[end].first == near_[k].first) ++end;
      std::ranges::sort(near_.begin() + static_cast<std::ptrdiff_t>(k),
                        near_.begin() + static_cast<std::ptrdiff_t>(end), {},
                        [&](const Pair& pair) { return p.sources.rank(pair.second); });
      const Cluster& a = p.targets.clusters()[near_[k].first];
      for (; k < end; ++k) {
        const Cluster& b = p.sources.clusters()[near_[k].second];
        const bool follows = !sweeps_.empty()
                             && sweeps_.back().rows.first == a.begin / p.pairs.targets
                             && sweeps_.back().rows.end == b.begin;
        if (!follows)
          sweeps_.push_back(
              {{a.begin / p.pairs.targets, a.end / p.pairs.targets, 1, b.begin, b.end}, 0});
        cost += std::uint64_t{a.end - a.begin} * (b.end - b.begin);
        sweeps_.back().rows.end = b.end;
        sweeps_.back().cost_so_far = cost;
      }
    }
  }

  void act_far(const ClusterProblem& p, std::size_t thread, std::size_t team) {
    const auto targets = p.targets.clusters(), sources = p.sources.clusters();
    const ExpansionKernel& kernel = p.expansions.kernel;
    const std::size_t lanes = kernel.lanes, batches = (far_.size() + lanes - 1) / lanes;
    const std::size_t last = batches * (thread + 1) / team;
    for (std::size_t k = batches * thread / team; k < last; ++k) {
      ExpansionKernel::Batch batch = idle_batch();
      for (std::size_t lane = 0; lane < lanes && k * lanes + lane < far_.size(); ++lane) {
        const auto [a, b] = far_[k * lanes + lane];
        const bool mutual = p.is_mutual(); // otherwise only b acts on a
        set_lane(batch, lane, mutual ? p.multipoles[a] : batch.from[0][lane],
                 local(p, thread, a), between(targets[a].centre, sources[b].centre));
        batch.from[1][lane] = p.multipoles[b];
        if (mutual) batch.to[1][lane] = local(p, thread, b);
      }
      kernel.multipoles_to_locals(p.expansions.numbers, batch);
    }
  }

  void act_near(const ClusterProblem& p, std::size_t thread, std::size_t team) {
    const auto add = p.is_mutual() ? p.pairs.add_fields : p.pairs.add_fields_one_way;
    const std::uint64_t total = near_pairs();
    // Each thread gets a share of equal cost. The sweeps of one leaf stay together, because they set
    // the same flags of close pairs.
    const auto at_cost = [&](std::uint64_t cost) {
      auto s = std::ranges::lower_bound(sweeps_, cost, {}, &Sweep::cost_so_far);
      while (s != sweeps_.begin() && s != sweeps_.end()
             && s->rows.first == std::prev(s)->rows.first)
        ++s;
      return s;
    };
    const auto end =
        thread + 1 == team ? sweeps_.end() : at_cost(total * (thread + 1) / team);
    for (auto s = at_cost(total * thread / team); s < end; ++s)
      add(p.charges.columns(), p.charges.field(thread), s->rows, p.charges.close());
  }

  // Adds up the local expansions of all threads, and passes them from parents to children and from
  // leaves to charges.
  void gather_locals(const ClusterProblem& p, std::size_t team) {
    const auto clusters = p.targets.clusters();
    const std::size_t numbers = p.expansions.set * clusters.size();
    double* sum = local(p, 0, 0);
    if (team > 1) {
#pragma omp for schedule(static)
      for (std::size_t i = 0; i < numbers; ++i)
        for (std::size_t t = 1; t < team; ++t) sum[i] += sum[i + t * numbers];
    }
    for (std::size_t level = 0; level + 1 < p.targets.levels().size(); ++level)
      shift_level(p.expansions, p.targets, level, sum, Shift::downward);
    const auto leaves = p.targets.leaves();
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const Cluster& leaf = clusters[leaves[i]];
      p.expansions.kernel.local_to_charges(p.expansions.numbers, p.charges.columns(),
                                           p.charges.field(0), leaf.begin, leaf.end,
                                           leaf.centre, local(p, 0, leaves[i]));
    }
  }

  /// The charges of a leaf and those of successive source leaves.
  struct Sweep {
    TileRows rows;
    std::uint64_t cost_so_far; ///< number of pairs of charges, including this sweep
  };
  std::vector<Lists> lists_;        ///< one per thread
  std::vector<Pair> open_, opened_; ///< pairs that have not been visited yet
  std::vector<Pair> far_, near_; ///< of all threads; near pairs are sorted by target leaves
  std::vector<std::size_t> first_;
  std::vector<Sweep> sweeps_;
  std::vector<CacheLine> locals_;
  bool met_coincident_ = false;
};

} // namespace

std::unique_ptr<FarField> make_fast_multipole() {
  return std::make_unique<FastMultipole>();
}

} // namespace ehdjet::detail
