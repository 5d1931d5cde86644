#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// How a quantity that links carry is spread along the links' arc length.
enum class Spread {
  linear,        ///< evenly: the cumulative quantity is piecewise linear
  monotone_cubic ///< the cumulative quantity is Steffen's monotone cubic: smooth, positive
};

/// Moves quantities that belong to links (volume, mass, charge, momentum) from one cut of a
/// stretch of string to another one.
///
///     Q*_j = C(S*_j) - C(S*_(j-1)),   C(S_i) = sum of Q up to knot i          (model 7)
///
/// laws   : the sum is kept to round-off; with the even spread every new value is an average of
///          old densities, so positive values stay positive and no bump gains or loses
/// source : Steffen, Astron. Astrophys. 239 (1990) 443, for the monotone cubic (GSL)
class Remap {
public:
  /// Knots of both cuts, ascending, with the same first and last entry [m].
  Remap(std::vector<double> from, std::vector<double> to, Spread spread);

  /// `quantity` (from - 1) per old link; returns (to - 1) per new link.
  [[nodiscard]] std::vector<double> operator()(std::span<const double> quantity) const;

private:
  /// What of an old link lies in a new one.
  struct Overlap {
    std::size_t from, to;
    double share; // of the old link
  };

  void find_overlaps();
  [[nodiscard]] std::vector<double> evenly(std::span<const double> quantity) const;
  [[nodiscard]] std::vector<double> smoothly(std::span<const double> quantity) const;

  std::vector<double> from_, to_;
  std::vector<Overlap> overlaps_; // of the even spread
};

} // namespace ehdjet
