#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// Charges that follow each other, and the ball they are in. Lengths in units of
/// 1/ExpansionKernel::unit.
struct Cluster {
  std::uint32_t begin = 0, end = 0; ///< charges; the end is a multiple of `padding`
  std::uint32_t child = 0;          ///< first of two that follow each other; 0: a leaf
  double centre[3] = {}, radius = 0;
  double low[3] = {}, high[3] = {}; ///< box
  double charge = 0;                ///< sum of |q|
  double square = 0;                ///< mean of q^2 over the charges that move
  double moving = 0;                ///< number of these, padding included
  double lumped = 1;                ///< what its series errs more than a smooth cluster's

  [[nodiscard]] bool is_leaf() const { return child == 0; }
};

/// Binary tree of ranges of charges: beads are sorted along the jet, so halving the index halves
/// the jet, without a sort and without moving anything. The shape depends on the number of charges
/// only.
class ClusterTree {
public:
  /// Of the charges [begin, begin + n); `begin` and `leaf`, the charges per leaf, are multiples of
  /// `padding`. Allocates if n is larger than ever before.
  void shape(std::size_t begin, std::size_t n, std::size_t leaf);
  /// Balls, boxes and charges of all clusters, leaves first. `moves` null: all charges move.
  void bound(const ChargeColumns& charges, const std::uint8_t* moves);
  /// Whether charges that follow each other are neighbours in space; otherwise leaves are as large
  /// as what is around them. A few charges far away do not count.
  [[nodiscard]] bool is_ordered() const;
  /// For the part of its error that a cluster's lumpiness adds (Multipoles::weigh).
  [[nodiscard]] std::span<Cluster> clusters() { return clusters_; }

  /// Level after level from the root, number 0; children behind their parents.
  [[nodiscard]] std::span<const Cluster> clusters() const { return clusters_; }
  [[nodiscard]] std::span<const std::uint32_t> leaves() const { return leaves_; }
  /// First cluster of each level, and the end of the last.
  [[nodiscard]] std::span<const std::uint32_t> levels() const { return levels_; }
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t charges() const { return n_; }
  /// Behind the last charge of a cluster, without padding.
  [[nodiscard]] std::size_t end_of(const Cluster& cluster) const {
    return std::min<std::size_t>(cluster.end, begin_ + n_);
  }
  /// Place of a leaf along the columns.
  [[nodiscard]] std::size_t rank(std::uint32_t leaf) const {
    return (clusters_[leaf].begin - begin_) / leaf_;
  }

private:
  void bound_leaf(const ChargeColumns& charges, const std::uint8_t* moves,
                  Cluster& leaf) const;
  static void bound_parent(const Cluster& a, const Cluster& b, Cluster& parent);

  std::size_t begin_ = 0, n_ = 0, leaf_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> leaves_, levels_;
};

} // namespace ehdjet::detail
