#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Moves quantities that belong to links (volume, mass, charge, momentum) from one cut of a
/// stretch of string to another one. A link's quantity is spread evenly along it:
///
///     Q*_j = C(S*_j) - C(S*_(j-1)),   C(S_i) = sum of Q up to knot i          (model 7)
///
/// laws   : the sum is kept to round-off; every new value is an average of old densities, so
///          positive values stay positive and no bump gains or loses
class Remap {
public:
  /// Knots of both cuts, ascending, with the same first and last entry [m].
  Remap(const std::vector<double>& from, const std::vector<double>& to);

  /// `quantity` (from - 1) per old link; returns (to - 1) per new link.
  [[nodiscard]] std::vector<double> operator()(std::span<const double> quantity) const;

private:
  /// What of an old link lies in a new one.
  struct Overlap {
    std::size_t from, to;
    double share; // of the old link
  };

  std::size_t old_links_, new_links_;
  std::vector<Overlap> overlaps_;
};

} // namespace ehdjet
