#include "ehdjet/events/dense_step.hpp"

#include <algorithm>

namespace ehdjet {

void IntegratorStep::state(double theta, std::span<double> out) const {
  if (theta == 0) {
    std::ranges::copy(jet.y, out.begin());
  } else if (theta == 1) {
    std::ranges::copy(integrator_.end_state(), out.begin());
  } else {
    integrator_.prepare_dense_output(system_);
    integrator_.dense_output(theta, 0, out);
  }
}

double IntegratorStep::component(double theta, std::size_t index) const {
  if (theta == 0) return jet.y[index];
  if (theta == 1) return integrator_.end_state()[index];
  integrator_.prepare_dense_output(system_);
  double value = 0;
  integrator_.dense_output(theta, index, {&value, 1});
  return value;
}

} // namespace ehdjet
