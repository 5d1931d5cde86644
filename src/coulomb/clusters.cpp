#include "clusters.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "multipoles.hpp"

namespace ehdjet::detail {
namespace {

constexpr std::size_t parallel_from = 1024;

/// From so many neighbours on, charges are sorted: sorted charges that fill space have fewer
/// neighbours than a curve that fills space. The leaves of a jet have at most 60.
constexpr double worth_sorting = 80;

double mean_neighbours(const ClusterTree& tree) {
  constexpr std::size_t samples = 8;
  constexpr double near = 3;
  const auto clusters = tree.clusters();
  const auto leaves = tree.leaves();
  std::size_t neighbours = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    const Cluster& a = clusters[leaves[(2 * k + 1) * leaves.size() / (2 * samples)]];
    for (const std::uint32_t leaf : leaves) {
      const Cluster& b = clusters[leaf];
      const auto [x, y, z] = between(a.centre, b.centre);
      const double reach = near * (a.radius + b.radius);
      neighbours += x * x + y * y + z * z < reach * reach ? 1 : 0;
    }
  }
  return static_cast<double>(neighbours) / samples;
}

} // namespace

int threads_for(std::size_t charges) {
  return charges < parallel_from ? 1 : omp_get_max_threads();
}

void Clusters::find(ScaledCharges& charges, std::size_t group, std::size_t leaf) {
  const ScaledCharges::Group& g = group == 0 ? charges.sources() : charges.targets();
  const std::size_t n = g.charges.size();
  tree.shape(g.begin, n, leaf);
  tree.bound(charges.columns(), charges.moves());
  const ClusterTree& found = tree;
  neighbours = mean_neighbours(found);
  sorted = neighbours > worth_sorting || !found.is_ordered();
  uneven = false;
  if (!sorted) return;
  sort(charges.columns());
  charges.reorder(group, order_);
  tree.bound(charges.columns(), charges.moves());
  neighbours = mean_neighbours(found);
  uneven = is_uneven();
}

// The leaves have equally many charges. In an evenly filled body, a layer or a ball nine of ten are at most 1.5
// times as large as one of ten; in a normally distributed cloud 3.5 times.
bool Clusters::is_uneven() {
  constexpr double contrast = 2.2;
  const std::span<const Cluster> clusters = std::as_const(tree).clusters();
  radii_.clear();
  for (const std::uint32_t leaf : tree.leaves()) radii_.push_back(clusters[leaf].radius);
  const auto at = [&](std::size_t tenths) {
    return radii_.begin() + static_cast<std::ptrdiff_t>(radii_.size() * tenths / 10);
  };
  std::ranges::nth_element(radii_, at(1));
  const double small = *at(1);
  std::ranges::nth_element(radii_, at(9));
  return *at(9) > contrast * small;
}

template <class Iterator>
std::size_t longest_side(Iterator from, Iterator to) {
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t side = 0; side < 3; ++side) {
    const auto [low, high] = std::minmax_element(
        from, to, [side](const auto& a, const auto& b) { return a.r[side] < b.r[side]; });
    if (high->r[side] - low->r[side] > length)
      longest = side, length = high->r[side] - low->r[side];
  }
  return longest;
}

// Halves each cluster of the tree across its longest side, level after level. A few distant charges
// then enlarge only the few clusters that contain them.
void Clusters::sort(const ChargeColumns& c) {
  const std::size_t begin = tree.begin(), n = tree.charges();
  points_.resize(n), order_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    points_[i] = {{c.x[begin + i], c.y[begin + i], c.z[begin + i]},
                  static_cast<std::uint32_t>(i)};
  const auto clusters = std::as_const(tree).clusters();
  for (std::size_t level = 0; level + 1 < tree.levels().size(); ++level) {
    const std::size_t first = tree.levels()[level], last = tree.levels()[level + 1];
#pragma omp parallel for schedule(dynamic) if (n >= parallel_from)
    for (std::size_t k = first; k < last; ++k) {
      const Cluster& cluster = clusters[k];
      if (cluster.is_leaf()) continue;
      const auto at = [&](std::size_t i) {
        return points_.begin() + static_cast<std::ptrdiff_t>(i - begin);
      };
      const auto from = at(cluster.begin), to = at(tree.end_of(cluster));
      const std::size_t longest = longest_side(from, to);
      std::ranges::nth_element(from, at(clusters[cluster.child].end), to, {},
                               [&](const Point& p) { return p.r[longest]; });
    }
  }
  for (std::size_t i = 0; i < n; ++i) order_[i] = points_[i].number;
}

double Crowding::of(const PointCharges& charges) {
  constexpr std::size_t leaf = 32;
  charges_.load({&charges, 1}, 1);
  clusters_.find(charges_, 0, leaf);
  // Fits to the numbers of neighbours along a whipping jet and in a cube (cost_model.cpp), with an
  // error of up to a fifth.
  const auto leaves = static_cast<double>(clusters_.tree.leaves().size());
  const double on_a_jet = std::clamp(7000 / leaves, 5.0, std::max(leaves, 5.0)),
               in_a_cloud = std::min(leaves, 45 * std::pow(leaves, 0.25));
  if (in_a_cloud < 1.3 * on_a_jet)
    return 0; // nearly all leaves are neighbours of each other
  return std::clamp(std::log(clusters_.neighbours / on_a_jet)
                        / std::log(in_a_cloud / on_a_jet),
                    0.0, 1.0);
}

} // namespace ehdjet::detail
