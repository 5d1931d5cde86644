#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cluster_tree.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// Threads for so many charges: below a thousand starting them costs more than they save.
int threads_for(std::size_t charges);

/// The cluster tree of one group of charges. Charges that do not follow a curve are brought into
/// an order in space first.
struct Clusters {
  ClusterTree tree;
  bool sorted = false;

  void find(ScaledCharges& charges, std::size_t group, std::size_t leaf);

private:
  std::vector<std::uint32_t> order_; ///< of the charges, if they were sorted
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys_;
};

} // namespace ehdjet::detail
