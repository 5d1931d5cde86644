#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <cstddef>
#include <optional>

namespace ehdjet {

/// What the start of a run has cost, and what follows from it for the whole run.
///
/// The number of beads and the place of the tip are taken to go on as powers of time, as they did in the
/// second half of the start, until the tip reaches the collector; from then on the number stays. A sum
/// costs what the cost model says of its number of beads, times what it has cost here over that.
struct CostEstimate {
  bool complete = false; ///< the run came to its end: what follows was measured
  double start = 0;      ///< simulated so far [s]
  double spent = 0;      ///< wall time so far [s]
  bool landed = false;   ///< beads have reached the collector
  double beads = 0;      ///< the largest number
  double evaluations = 0;
  double wall_time = 0; ///< of the whole run [s]
  double frames = 0;    ///< size of all frames before they are packed [bytes]
  /// Two rates are possible, and there are enough beads for them in the end, but not yet.
  bool two_rates_later = false;
};

/// Simulates the start of a scene for that long [s], without writing anything.
/// errors : as run_scene
CostEstimate probe_cost(const Scene& scene, double seconds,
                        std::optional<std::size_t> threads = {});

} // namespace ehdjet
