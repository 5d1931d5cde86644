#pragma once

#include "ehdjet/simulation/array_simulation.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <initializer_list>
#include <string_view>

namespace ehdjet::cli {

/// Shows how much of a run is done and estimates the remaining time, on standard error. On a
/// terminal it rewrites one line, which has as many parts as the terminal is wide for; otherwise it prints a
/// line every few seconds.
class Progress {
public:
  Progress(double start_time, double end_time);
  ~Progress(); ///< clears the line on a terminal
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  [[nodiscard]] double wall_time() const; ///< since the start [s]
  /// Makes room for a message.
  void clear() const;
  void show(const Simulation& simulation);
  void show(const ArraySimulation& simulation);

private:
  void show(double t, std::size_t beads, const RunStatistics& statistics);
  /// `parts` by importance; `part` of the run that is done.
  static void rewrite_line(std::initializer_list<std::string_view> parts, double part);

  struct Sample {
    double wall, time; // [s], [s]
  };

  bool terminal_;
  double start_time_, end_time_, interval_, next_;
  std::deque<Sample> recent_; // only the last ones: the cost per time grows with the jet
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace ehdjet::cli
