#pragma once

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <array>
#include <cstddef>
#include <functional>

/// The paper's Table 2: what the jet of case I costs for each length of refinement.
namespace ehdjet {

/// A row as published: 0.2 s with RK4 and steps of 1e-8 s.
struct Table2Row {
  const char *name, *scene; ///< L~ in cm or "none"; scenes/<scene>.toml
  double length;            ///< L~ [m]; 0: none
  double beads;             ///< mean number
  int processors;
  double wall, efficiency; ///< [s], [-]
};
inline constexpr std::array<Table2Row, 4> table2{
    {{"none", "table2_none", 0, 150, 24, 8787, 0.26},
     {"0.8", "table2_08", 0.008, 267, 24, 12718, 0.44},
     {"0.4", "table2_04", 0.004, 509, 24, 24726, 0.62},
     {"0.2", "table2_02", 0.002, 1123, 24, 75793, 0.80}}};

/// A row as measured here. Beads are links of the chain.
struct Table2Run {
  double mean_beads = 0, stationary_beads = 0; ///< over all times, over the stationary ones
  /// Right before each refinement of the stationary jet, which is what the published run would
  /// have counted at its multiples of t_ref; not a number without refinements.
  double beads_before = 0;
  RunStatistics statistics;
};

/// Runs a scene of the table on `threads` threads to `end_time` [s]; it is stationary from
/// `stationary_from` on [s]. `prepare` may add observers, `after_step` is called after each step.
Table2Run run_table2(Scene scene, double end_time, double stationary_from,
                     std::size_t threads, const std::function<void(Simulation&)>& prepare,
                     const Simulation::StepHook& after_step = {});

} // namespace ehdjet
