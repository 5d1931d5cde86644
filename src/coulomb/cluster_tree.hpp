#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// Successive charges and a ball that contains them. The unit of length is 1/ExpansionKernel::unit.
struct Cluster {
  std::uint32_t begin = 0, end = 0; ///< charges; the end is a multiple of `padding`
  std::uint32_t child = 0;          ///< the first of two successive children; 0: a leaf
  double centre[3] = {}, radius = 0;
  double low[3] = {}, high[3] = {}; ///< box
  /// Direction from the first to the last charge, and a bound for the distance of the charges from
  /// the line in this direction through the centre. On a smooth curve small clusters are straight.
  double axis[3] = {}, width = 0;
  double charge = 0; ///< sum of |q|
  double square = 0; ///< mean of q^2 over the charges that move
  double moving = 0; ///< number of these charges, including padding
  double lumped = 1; ///< error of its series relative to a smooth cluster

  [[nodiscard]] bool is_leaf() const { return child == 0; }
};

/// Binary tree of ranges of charges. Beads are ordered along the jet: if a range of indices is
/// halved, the piece of the jet is halved too. This needs no sorting. The shape of the tree depends
/// only on the number of charges.
class ClusterTree {
public:
  /// Sets the tree of the charges [begin, begin + n). `begin` and the number `leaf` of charges per
  /// leaf are multiples of `padding`. Allocates only if n is larger than in all earlier calls.
  void shape(std::size_t begin, std::size_t n, std::size_t leaf);
  /// Computes balls, boxes and charges of all clusters. If `moves` is null, all charges move.
  void bound(const ChargeColumns& charges, const std::uint8_t* moves);
  /// Whether successive charges are neighbours in space. A few distant charges do not matter.
  [[nodiscard]] bool is_ordered() const;
  /// Writable, for Multipoles::weigh.
  [[nodiscard]] std::span<Cluster> clusters() { return clusters_; }

  /// Level after level, from the root with number 0.
  [[nodiscard]] std::span<const Cluster> clusters() const { return clusters_; }
  [[nodiscard]] std::span<const std::uint32_t> leaves() const { return leaves_; }
  /// The first cluster of each level, and the end of the last level.
  [[nodiscard]] std::span<const std::uint32_t> levels() const { return levels_; }
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t charges() const { return n_; }
  /// The end of the charges of a cluster, without padding.
  [[nodiscard]] std::size_t end_of(const Cluster& cluster) const {
    return std::min<std::size_t>(cluster.end, begin_ + n_);
  }
  /// Position of a leaf in the order of the charges.
  [[nodiscard]] std::size_t rank(std::uint32_t leaf) const {
    return (clusters_[leaf].begin - begin_) / leaf_;
  }

private:
  void bound_leaf(const ChargeColumns& charges, const std::uint8_t* moves,
                  Cluster& leaf) const;
  void bound_parent(const ChargeColumns& charges, Cluster& parent) const;
  void set_axis(const ChargeColumns& charges, Cluster& cluster) const;

  std::size_t begin_ = 0, n_ = 0, leaf_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> leaves_, levels_;
};

} // namespace ehdjet::detail
