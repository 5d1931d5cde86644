#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cluster_tree.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// The number of threads for so many charges. For fewer than about a thousand charges, starting
/// threads takes longer than they save.
int threads_for(std::size_t charges);

/// The cluster tree of one group of charges. Unordered charges, and curves that fill space, are
/// first sorted in space.
struct Clusters {
  ClusterTree tree;
  bool sorted = false;
  /// Mean number of leaves whose distance from a leaf is below three times the sum of the radii.
  double neighbours = 0;
  /// Whether charges fill space with very different density.
  bool uneven = false;

  void find(ScaledCharges& charges, std::size_t group, std::size_t leaf);
  /// Loaded again, without any change, as group `group`: only their order has to be restored.
  void find_again(ScaledCharges& charges, std::size_t group) const {
    if (sorted) charges.reorder(group, order_);
  }

private:
  std::vector<std::uint32_t> order_; ///< of the charges, if they have been sorted
  struct Point {
    std::array<double, 3> r;
    std::uint32_t number;
  };
  void sort(const ChargeColumns& charges);
  [[nodiscard]] bool is_uneven();
  std::vector<Point> points_;
  std::vector<double> radii_; ///< of the leaves
};

/// A measure of how crowded charges are: 0 along a single jet, 1 where they fill space. It follows
/// from the number of neighbours of the leaves of a cluster tree.
class Crowding {
public:
  /// cost : that of a cluster tree, about a hundredth of a force call
  double of(const PointCharges& charges);

private:
  ScaledCharges charges_;
  Clusters clusters_;
};

} // namespace ehdjet::detail
