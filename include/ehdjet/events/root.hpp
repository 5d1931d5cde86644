#pragma once

#include <functional>
#include <optional>

namespace ehdjet {

/// First theta in (0, 1] with g >= 0, given g(0) < 0: Brent's method on the bracket [0, 1].
/// Nothing if g(1) < 0. At the returned theta g is >= 0 to round-off, never before the root.
/// errors : RunError if g is not a finite number where it is needed
std::optional<double> first_crossing(const std::function<double(double)>& g);

/// Where the parabola with these values at theta = 0 and 1 and this slope (per theta) at 1 crosses
/// zero upwards beyond theta = 1, if it does.
std::optional<double> expected_crossing(double g0, double g1, double slope1);

} // namespace ehdjet
