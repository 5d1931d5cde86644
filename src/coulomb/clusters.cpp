#include "clusters.hpp"

#include <omp.h>

#include <algorithm>

#include "expansion_kernel.hpp"

namespace ehdjet::detail {
namespace {

/// Bits of three numbers of 21 bits each, interleaved: neighbours in space are mostly neighbours
/// in this order (Morton's).
std::uint64_t interleaved(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 32U) & 0x1f00000000ffffU;
    v = (v | v << 16U) & 0x1f0000ff0000ffU;
    v = (v | v << 8U) & 0x100f00f00f00f00fU;
    v = (v | v << 4U) & 0x10c30c30c30c30c3U;
    return (v | v << 2U) & 0x1249249249249249U;
  };
  return spread(x) | spread(y) << 1U | spread(z) << 2U;
}

} // namespace

int threads_for(std::size_t charges) {
  constexpr std::size_t parallel_from = 1024;
  return charges < parallel_from ? 1 : omp_get_max_threads();
}

void Clusters::find(ScaledCharges& charges, std::size_t group, std::size_t leaf) {
  const ScaledCharges::Group& g = group == 0 ? charges.sources() : charges.targets();
  const std::size_t n = g.charges.size();
  tree.shape(g.begin, n, leaf);
  tree.bound(charges.columns(), charges.moves());
  sorted = !tree.is_ordered();
  if (!sorted) return;
  const Cluster& all = tree.clusters()[0];
  const ChargeColumns c = charges.columns();
  const double size = std::max({all.high[0] - all.low[0], all.high[1] - all.low[1],
                                all.high[2] - all.low[2], 1e-300});
  const double cells = 0x1fffff / size;
  keys_.resize(n), order_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto cell = [&](const double* column, int k) {
      return static_cast<std::uint64_t>(
          (column[g.begin + i] * ExpansionKernel::unit - all.low[k]) * cells);
    };
    keys_[i] = {interleaved(cell(c.x, 0), cell(c.y, 1), cell(c.z, 2)),
                static_cast<std::uint32_t>(i)};
  }
  std::ranges::sort(keys_);
  for (std::size_t i = 0; i < n; ++i) order_[i] = keys_[i].second;
  charges.reorder(group, order_);
  tree.bound(charges.columns(), charges.moves());
}

} // namespace ehdjet::detail
