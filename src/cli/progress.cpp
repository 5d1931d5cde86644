#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

namespace ehdjet::cli {
namespace {

constexpr double terminal_interval = 0.1, plain_interval = 5; // [s]
constexpr std::size_t samples = 30;

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 100) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

} // namespace

Progress::Progress(double start_time, double end_time)
    : terminal_(isatty(STDERR_FILENO) != 0)
    , start_time_(start_time)
    , end_time_(end_time)
    , interval_(terminal_ ? terminal_interval : plain_interval)
    , next_(interval_) {}

void Progress::show(const Simulation& simulation) {
  show(simulation.jet().time, simulation.jet().links(), simulation.statistics());
}

void Progress::show(const ArraySimulation& simulation) {
  show(simulation.time(), simulation.links(), simulation.statistics());
}

void Progress::show(double t, std::size_t beads, const RunStatistics& statistics) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const double wall = elapsed.count();
  if (wall < next_) return;
  next_ = wall + interval_;
  recent_.push_back({wall, t});
  if (recent_.size() > samples) recent_.pop_front();
  const Sample first = recent_.size() > 1 ? recent_.front() : Sample{0, start_time_};
  const double left = (wall - first.wall) * (end_time_ - t) / (t - first.time);

  const double part = t / end_time_;
  const std::string line = fmt::format(
      "{:3.0f} %  t = {:.4g} of {:.4g} s  {} beads  {} evaluations  {} elapsed, {} left",
      100 * part, t, end_time_, beads, statistics.evaluations, duration(wall),
      duration(left));
  if (!terminal_) {
    fmt::print(stderr, "{}\n", line);
    return;
  }
  constexpr int width = 20;
  const auto filled = static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * width);
  fmt::print(stderr, "\r[{:.<{}}] {}\033[K", std::string(filled, '#'), width, line);
  std::fflush(stderr);
}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

} // namespace ehdjet::cli
