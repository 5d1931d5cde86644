#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cluster_tree.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// Threads for so many charges: below a thousand starting them costs more than they save.
int threads_for(std::size_t charges);

/// The cluster tree of one group of charges. Charges in no order, and curves that fill space, are
/// brought into an order in space first.
struct Clusters {
  ClusterTree tree;
  bool sorted = false;
  double neighbours = 0; ///< of a leaf: others within three times the sum of the radii

  void find(ScaledCharges& charges, std::size_t group, std::size_t leaf);

private:
  std::vector<std::uint32_t> order_; ///< of the charges, if they were sorted
  struct Point {
    std::array<double, 3> r;
    std::uint32_t number;
  };
  void sort(const ChargeColumns& charges);
  std::vector<Point> points_;
};

} // namespace ehdjet::detail
