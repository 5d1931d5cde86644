#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

constexpr double terminal_interval = 0.1, plain_interval = 5; // [s]
constexpr std::size_t samples = 30;

/// A terminal that can rewrite a line.
bool is_terminal() {
  const char* name = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && name != nullptr && std::string_view(name) != "dumb";
}

/// Columns of the terminal now: a window may change its size at any time.
std::size_t columns() {
  constexpr std::size_t usual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col
                                                                         : usual;
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 100) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

} // namespace

Progress::Progress(double start_time, double end_time)
    : terminal_(is_terminal())
    , start_time_(start_time)
    , end_time_(end_time)
    , interval_(terminal_ ? terminal_interval : plain_interval)
    , next_(interval_) {}

void Progress::show(const Simulation& simulation) {
  show(simulation.jet().time, simulation.jet().beads(), simulation.statistics());
}

void Progress::show(const ArraySimulation& simulation) {
  show(simulation.time(), simulation.beads(), simulation.statistics());
}

void Progress::show(double t, std::size_t beads, const RunStatistics& statistics) {
  const double wall = wall_time();
  if (wall < next_) return;
  next_ = wall + interval_;
  recent_.push_back({wall, t});
  if (recent_.size() > samples) recent_.pop_front();
  const Sample first = recent_.size() > 1 ? recent_.front() : Sample{0, start_time_};
  const double left = (wall - first.wall) * (end_time_ - t) / (t - first.time);

  const double part = t / end_time_;
  const std::string percent = fmt::format("{:3.0f} %", 100 * part),
                    rest = fmt::format("{} left", duration(left)),
                    time = fmt::format("t = {:.4g} of {:.4g} s", t, end_time_),
                    size = fmt::format("{} beads", beads),
                    past = fmt::format("{} elapsed", duration(wall)),
                    cost = fmt::format("{} evaluations", statistics.evaluations);
  if (!terminal_) {
    message("{}  {}  {}  {}  {}, {}\n", percent, time, size, cost, past, rest);
    return;
  }
  rewrite_line({percent, rest, time, size, past, cost}, part);
}

// One column stays free, because some terminals start a new line when the last one is written. The cursor
// waits at the start of the line: a terminal that breaks the line when it becomes narrower keeps it there.
void Progress::rewrite_line(std::initializer_list<std::string_view> parts, double part) {
  const std::size_t width = columns() - 1;
  std::string line;
  for (const std::string_view next : parts) {
    if (line.size() + 2 + next.size() > width) break;
    if (!line.empty()) line += "  ";
    line += next;
  }
  constexpr std::size_t bar = 20;
  if (line.size() + bar + 3 <= width) {
    const auto filled = static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * bar);
    line = fmt::format("[{:.<{}}] {}", std::string(filled, '#'), bar, line);
  }
  write_to_terminal(fmt::format("\r{}\033[J\r", line));
}

double Progress::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::clear() const {
  if (terminal_) write_to_terminal("\r\033[J");
}

Progress::~Progress() {
  clear();
}

} // namespace ehdjet::cli
