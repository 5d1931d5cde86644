#pragma once

#include <limits>
#include <optional>

namespace ehdjet {

/// How long a step may be.
struct StepLimits {
  std::optional<double>
      fixed; ///< dt of every step, for methods without error estimate too [s]
  std::optional<double> initial;                            ///< first attempt [s]
  double longest = std::numeric_limits<double>::infinity(); ///< [s]
  double shortest = 1e-15; ///< below this the run stops [s]
  /// A step in which a link becomes shorter than this is too long, and if no step is short
  /// enough, the run stops; 0: links may vanish [m].
  double shortest_link = 0;
  /// The last two steps before the end of a run are equally long, and the step after it does not
  /// depend on how short they were: for many short runs one after the other.
  bool even_at_end = false;
};

} // namespace ehdjet
