#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace ehdjet {

/// Akima's piecewise cubic through values at given knots; every column of a jet has the same knots.
///
/// laws   : linear data are reproduced on any mesh, quadratic ones on uniform meshes only; local:
///          a value acts on three intervals to either side
/// GSL, which computes the spline, needs five knots. Fewer knots (at least two) are continued by
/// Akima's own rule for the ends, with slopes that change linearly. Three uniform knots then give the
/// parabola, and two the straight line.
/// source : H. Akima, J. ACM 17 (1970) 589
class AkimaSpline {
public:
  /// `knots`: strictly increasing, at least two.
  explicit AkimaSpline(std::span<const double> knots);
  ~AkimaSpline();
  AkimaSpline(const AkimaSpline&) = delete;
  AkimaSpline& operator=(const AkimaSpline&) = delete;

  /// out_i = value at at_i, for `values` (one per knot). `at` lies within the knots; ascending
  /// order is fastest.
  void interpolate(std::span<const double> values, std::span<const double> at,
                   std::span<double> out);

private:
  struct Gsl;
  std::vector<double> knots_, values_; // continued to five
  std::size_t given_;
  std::unique_ptr<Gsl> gsl_;
};

} // namespace ehdjet
