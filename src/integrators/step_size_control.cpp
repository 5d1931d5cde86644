#include "ehdjet/integrators/step_size_control.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {
namespace {

constexpr double safety = 0.9, smallest_factor = 0.2, largest_factor = 5, beta = 0.04;

} // namespace

double StepSizeControl::after_accepted(double h, double error) {
  error = std::max(error,
                   1e-10); // an error of zero does not tell how long the next step can be
  const double factor = safety * std::pow(error, -(1.0 / order_ - 0.75 * beta))
                        * std::pow(previous_error_, beta);
  previous_error_ = std::max(error, 1e-4);
  // A step that follows a rejection must not grow, or it would be rejected again.
  const double most = rejected_ ? 1.0 : largest_factor;
  rejected_ = false;
  return h * std::clamp(factor, smallest_factor, most);
}

double StepSizeControl::after_rejected(double h, double error) {
  rejected_ = true;
  if (!std::isfinite(error)) return h * smallest_factor;
  return h * std::clamp(safety * std::pow(error, -1.0 / order_), smallest_factor, safety);
}

} // namespace ehdjet
