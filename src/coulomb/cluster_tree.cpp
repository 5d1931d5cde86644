#include "cluster_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "multipoles.hpp"

namespace ehdjet::detail {
namespace {

constexpr std::size_t parallel_from = 4096; // charges
constexpr std::size_t parallel_from_parents = 1024;
constexpr std::size_t part_of_leaves = 64; // number of leaves that are compared

/// Compares the size of the leaves with the size of all of them together. The leaves of a curve are
/// smaller than those of charges that fill space. The leaves of unordered charges are as large as
/// all charges together. The outer tenths are left out, because any leaf may have a distant charge.
bool are_ordered(std::span<const Cluster> clusters, std::span<const std::uint32_t> leaves) {
  std::array<double, part_of_leaves> values;
  const auto number = static_cast<double>(leaves.size());
  const auto of_leaves = [&](double part, auto value) { // a quantile
    const auto end =
        std::ranges::transform(leaves, values.begin(), [&](std::uint32_t leaf) {
          return value(clusters[leaf]);
        }).out;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * (number - 1));
    std::nth_element(values.begin(), at, end);
    return *at;
  };
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double low = of_leaves(0.1, [k](const Cluster& c) { return c.low[k]; });
    const double high = of_leaves(0.9, [k](const Cluster& c) { return c.high[k]; });
    square += (high - low) * (high - low);
  }
  const double leaf = of_leaves(0.5, [](const Cluster& c) { return c.radius; });
  return leaf <= 1.5 * std::sqrt(square) / 2 / std::cbrt(number);
}

} // namespace

void ClusterTree::shape(std::size_t first, std::size_t n, std::size_t leaf) {
  if (first == begin_ && n == n_ && leaf == leaf_) return;
  begin_ = first, n_ = n, leaf_ = leaf;
  clusters_.clear(), leaves_.clear(), levels_.clear();
  const std::size_t length = (n + padding - 1) / padding * padding;
  clusters_.push_back({.begin = static_cast<std::uint32_t>(first),
                       .end = static_cast<std::uint32_t>(first + length)});
  levels_.push_back(0);
  std::size_t level_end = 1;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    if (i == level_end)
      levels_.push_back(static_cast<std::uint32_t>(i)), level_end = clusters_.size();
    const std::uint32_t begin = clusters_[i].begin, end = clusters_[i].end;
    if (end - begin <= leaf) {
      leaves_.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    // Each half is a whole number of leaves. All leaves except the last one are full.
    const std::size_t pieces = (end - begin + leaf - 1) / leaf;
    const auto middle = static_cast<std::uint32_t>(begin + pieces / 2 * leaf);
    clusters_[i].child = static_cast<std::uint32_t>(clusters_.size());
    clusters_.push_back({.begin = begin, .end = middle});
    clusters_.push_back({.begin = middle, .end = end});
  }
  levels_.push_back(static_cast<std::uint32_t>(clusters_.size()));
}

void ClusterTree::bound(const ChargeColumns& charges, const std::uint8_t* moves) {
#pragma omp parallel for schedule(static) if (n_ >= parallel_from)
  for (std::size_t i = 0; i < leaves_.size(); ++i)
    bound_leaf(charges, moves, clusters_[leaves_[i]]);
  for (std::size_t level = levels_.size() - 1; level-- > 0;) {
    const std::size_t begin = levels_[level], end = levels_[level + 1];
#pragma omp parallel for schedule(static) if (end - begin >= parallel_from_parents)
    for (std::size_t i = begin; i < end; ++i)
      if (Cluster& c = clusters_[i]; !c.is_leaf()) bound_parent(charges, c);
  }
}

void ClusterTree::bound_leaf(const ChargeColumns& charges, const std::uint8_t* moves,
                             Cluster& leaf) const {
  const std::size_t end = end_of(leaf);
  const double* columns[3] = {charges.x, charges.y, charges.z};
  for (int k = 0; k < 3; ++k) {
    double low = columns[k][leaf.begin], high = low;
    for (std::size_t i = leaf.begin; i < end; ++i)
      low = std::min(low, columns[k][i]), high = std::max(high, columns[k][i]);
    leaf.low[k] = low * ExpansionKernel::unit, leaf.high[k] = high * ExpansionKernel::unit;
    leaf.centre[k] = (leaf.low[k] + leaf.high[k]) / 2;
  }
  set_axis(charges, leaf);
  double square = 0, width = 0; // squared
  leaf.charge = leaf.square = leaf.moving = 0;
  for (std::size_t i = leaf.begin; i < end; ++i) {
    double d2 = 0, along = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = columns[k][i] * ExpansionKernel::unit - leaf.centre[k];
      d2 += d * d, along += d * leaf.axis[k];
    }
    square = std::max(square, d2);
    width = std::max(width, d2 - along * along);
    leaf.charge += std::abs(charges.q[i]);
    if (moves != nullptr && moves[i] == 0) continue;
    leaf.square += charges.q[i] * charges.q[i], ++leaf.moving;
  }
  if (leaf.moving > 0) leaf.square /= leaf.moving;
  if (moves == nullptr) leaf.moving = leaf.end - leaf.begin;
  leaf.radius = std::sqrt(square), leaf.width = std::sqrt(width);
}

void ClusterTree::set_axis(const ChargeColumns& charges, Cluster& cluster) const {
  const std::size_t first = cluster.begin, last = end_of(cluster) - 1;
  const double* columns[3] = {charges.x, charges.y, charges.z};
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    cluster.axis[k] = (columns[k][last] - columns[k][first]) * ExpansionKernel::unit;
    square += cluster.axis[k] * cluster.axis[k];
  }
  for (double& a : cluster.axis) a = square > 0 ? a / std::sqrt(square) : 0;
}

void ClusterTree::bound_parent(const ChargeColumns& charges, Cluster& parent) const {
  const Cluster &a = clusters_[parent.child], &b = clusters_[parent.child + 1];
  for (int k = 0; k < 3; ++k) {
    parent.low[k] = std::min(a.low[k], b.low[k]);
    parent.high[k] = std::max(a.high[k], b.high[k]);
    parent.centre[k] = (parent.low[k] + parent.high[k]) / 2;
  }
  double reach = 0; // radius of a ball that contains the children's balls
  for (const Cluster* c : {&a, &b})
    reach = std::max(reach, c->radius + between(parent.centre, c->centre).norm());
  parent.radius = std::min(reach, between(parent.low, parent.high).norm() / 2);
  set_axis(charges, parent);
  parent.width = 0;
  for (const Cluster* c : {&a, &b}) {
    double off = 0, along = 0, cosine = 0; // the child's centre and axis
    for (int k = 0; k < 3; ++k) {
      const double d = c->centre[k] - parent.centre[k];
      off += d * d, along += d * parent.axis[k], cosine += c->axis[k] * parent.axis[k];
    }
    const double turned =
        c->width + c->radius * std::sqrt(std::max(0.0, 1 - cosine * cosine));
    parent.width = std::max(parent.width, std::sqrt(std::max(0.0, off - along * along))
                                              + std::min(c->radius, turned));
  }
  parent.charge = a.charge + b.charge;
  parent.moving = a.moving + b.moving;
  parent.square =
      parent.moving > 0 ? (a.square * a.moving + b.square * b.moving) / parent.moving : 0;
}

// Several parts are examined separately: groups of charges may follow each other in order, while the
// charges within each group do not.
bool ClusterTree::is_ordered() const {
  constexpr std::size_t too_few = 16, most_parts = 8;
  if (leaves_.size() < too_few) return true;
  const std::span<const std::uint32_t> leaves(leaves_);
  const std::size_t length = std::min(part_of_leaves, leaves.size()),
                    parts = std::min(most_parts, leaves.size() / length);
  std::size_t ordered = 0;
  for (std::size_t k = 0; k < parts; ++k) {
    const std::size_t begin = parts == 1 ? 0 : (leaves.size() - length) * k / (parts - 1);
    if (are_ordered(clusters_, leaves.subspan(begin, length))) ++ordered;
  }
  return 2 * ordered > parts;
}

} // namespace ehdjet::detail
