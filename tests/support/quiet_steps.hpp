#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "support/allocations.hpp"

namespace ehdjet::test {

/// Expects that no step of a run of a millisecond allocates while the beads stay. `S`: Simulation or
/// ArraySimulation.
template <class S>
void expect_quiet_steps(S& simulation, const std::string& method) {
  std::size_t before = 0, allocated = 0;
  long steps = 0, since_event = 0;
  std::uint64_t events = 0;
  simulation.after_each_step([&](const S& s) {
    // The step after an event meets a chain of another size.
    const std::uint64_t now = s.statistics().insertions + s.statistics().releases;
    since_event = now == events ? since_event + 1 : 0;
    events = now;
    if (since_event > 1) allocated += allocations() - before, ++steps;
    before = allocations();
  });
  simulation.run_until(1e-3);
  EXPECT_GT(steps, 30) << method;
  EXPECT_EQ(allocated, 0U) << method;
}

} // namespace ehdjet::test
