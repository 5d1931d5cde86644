#pragma once

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <array>
#include <cstddef>
#include <functional>

/// The paper's Table 2: the cost of the jet of case I for each refinement length.
namespace ehdjet {

/// A published row: 0.2 s with RK4 and steps of 1e-8 s.
struct Table2Row {
  const char *name, *scene; ///< L~ in cm or "none"; scenes/<scene>.toml
  double length;            ///< L~ [m]; 0: none
  double beads;             ///< mean number
  int processors;
  double wall, efficiency; ///< [s], [-]

  [[nodiscard]] constexpr bool is_published() const { return processors > 0; }
};
inline constexpr std::array<Table2Row, 4> table2{
    {{"none", "table2_none", 0, 150, 24, 8787, 0.26},
     {"0.8", "table2_08", 0.008, 267, 24, 12718, 0.44},
     {"0.4", "table2_04", 0.004, 509, 24, 24726, 0.62},
     {"0.2", "table2_02", 0.002, 1123, 24, 75793, 0.80}}};

/// Finer meshes than the paper's: the scene of its last row with another refinement length, and with
/// links at the nozzle that are at most half as long. There are no published numbers.
inline constexpr std::array<Table2Row, 3> table2_finer{
    {{"0.1", "table2_02", 0.001, 0, 0, 0, 0},
     {"0.05", "table2_02", 0.0005, 0, 0, 0, 0},
     {"0.02", "table2_02", 0.0002, 0, 0, 0, 0}}};

/// A measured row. The published counts of beads are those of links, which leave out bead 0.
struct Table2Run {
  double mean_links = 0,
         stationary_links = 0; ///< mean over all times, over the stationary times
  /// Mean just before each refinement of the stationary jet. The published run would have counted
  /// these links at its multiples of t_ref. NaN without refinements.
  double links_before = 0;
  RunStatistics statistics;
};

/// Runs a scene of the table on `threads` threads to `end_time` [s]. The jet is stationary from
/// `stationary_from` [s] on. `prepare` may add observers; `after_step` is called after each step.
Table2Run run_table2(Scene scene, double end_time, double stationary_from,
                     std::size_t threads, const std::function<void(Simulation&)>& prepare,
                     const Simulation::StepHook& after_step = {});

} // namespace ehdjet
