#include "ehdjet/refinement/remap.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>

namespace ehdjet {

Remap::Remap(const std::vector<double>& from, const std::vector<double>& to)
    : old_links_(from.size() - 1)
    , new_links_(to.size() - 1) {
  EHDJET_EXPECTS(from.size() >= 2 && to.size() >= 2);
  EHDJET_EXPECTS(from.front() == to.front() && from.back() == to.back());
  overlaps_.reserve(from.size() + to.size());
  for (std::size_t i = 0, j = 0; i < old_links_ && j < new_links_;) {
    const double start = std::max(from[i], to[j]);
    const double end = std::min(from[i + 1], to[j + 1]);
    if (end > start) overlaps_.push_back({i, j, (end - start) / (from[i + 1] - from[i])});
    (from[i + 1] < to[j + 1] ? i : j) += 1;
  }
}

// Overlap by overlap rather than as a difference of cumulative sums: a small link keeps its digits.
std::vector<double> Remap::operator()(std::span<const double> quantity) const {
  EHDJET_EXPECTS(quantity.size() == old_links_);
  std::vector<double> moved(new_links_, 0.0);
  for (const Overlap& o : overlaps_) moved[o.to] += quantity[o.from] * o.share;
  return moved;
}

} // namespace ehdjet
