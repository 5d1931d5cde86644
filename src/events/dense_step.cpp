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

void RowsOfStep::state(double theta, std::span<double> out) const {
  const std::size_t n = jet.beads();
  for (std::size_t first = 0; first < out.size(); first += n)
    read(theta, first, out.subspan(first, n));
}

double RowsOfStep::component(double theta, std::size_t index) const {
  double value = 0;
  read(theta, index, {&value, 1});
  return value;
}

/// Components from `index` of the jet on, which are in one column.
void RowsOfStep::read(double theta, std::size_t index, std::span<double> out) const {
  const std::size_t n = jet.beads(),
                    there =
                        index / n * all_ + first_ + index % n; // among those of all jets
  if (theta == 0) {
    std::ranges::copy(std::span(jet.y).subspan(index, out.size()), out.begin());
  } else if (theta == 1) {
    std::ranges::copy(integrator_.end_state().subspan(there, out.size()), out.begin());
  } else {
    integrator_.prepare_dense_output(system_);
    integrator_.dense_output(theta, there, out);
  }
}

} // namespace ehdjet
