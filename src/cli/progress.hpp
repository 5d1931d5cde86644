#pragma once

#include "ehdjet/simulation/simulation.hpp"

#include <chrono>
#include <deque>

namespace ehdjet::cli {

/// Shows how far a run is and how long it may still take: one line that is rewritten on a
/// terminal, a plain line now and then elsewhere. Writes to standard error.
class Progress {
public:
  Progress(double start_time, double end_time);
  ~Progress(); ///< leaves the terminal at the start of an empty line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(const Simulation& simulation);

private:
  struct Sample {
    double wall, time; // [s], [s]
  };
  [[nodiscard]] double seconds() const;

  bool terminal_;
  double start_time_, end_time_, interval_, next_;
  std::deque<Sample>
      recent_; // only the last ones, because the cost of a millisecond grows with the jet
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace ehdjet::cli
