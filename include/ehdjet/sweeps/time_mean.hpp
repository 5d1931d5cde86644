#pragma once

#include <optional>
#include <span>

namespace ehdjet {

/// Mean of a stationary series.
struct TimeMean {
  double mean = 0;
  /// What is to be expected of |mean - exact|; none with fewer than eight values.
  std::optional<double> standard_error;
};

/// Mean of values at equal distances in time, at least one, and its standard error
/// s sqrt(2 tau / n). Successive values are not independent: tau >= 1/2 is their integrated
/// autocorrelation time in steps, with the window that Sokal proposes, the least M >= 5 tau(M)
/// (A. Sokal, Monte Carlo Methods in Statistical Mechanics, 1997, section 3). The error is too small for a
/// series of less than about fifty tau.
TimeMean time_mean(std::span<const double> values);

} // namespace ehdjet
