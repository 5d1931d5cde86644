#pragma once

#include "ehdjet/simulation/simulation.hpp"

/// What steps with two rates cost.
namespace ehdjet::test {

/// Evaluations of the downstream beads and Coulomb sums, per millisecond.
struct Cost {
  double evaluations, full_sums;
};

/// Of a run between two times, the first of which it has not passed yet [s].
inline Cost cost_between(Simulation& simulation, double from, double to) {
  simulation.run_until(from);
  const RunStatistics a = simulation.statistics();
  simulation.run_until(to);
  const RunStatistics& b = simulation.statistics();
  const double ms = 1e3 * (to - from);
  return {.evaluations = static_cast<double>(b.evaluations - a.evaluations) / ms,
          .full_sums = (b.two_rates->full_sums - a.two_rates->full_sums) / ms};
}

} // namespace ehdjet::test
