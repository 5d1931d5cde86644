#include "cost_watch.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ehdjet::cli {
namespace {

constexpr double hour = 3600, day = 24 * hour, year = 365 * day; // [s]
constexpr double far_more = 5;

std::string period(double seconds) {
  if (!(seconds < 100 * year)) return "centuries";
  if (seconds >= year) return fmt::format("{:.1f} years", seconds / year);
  if (seconds >= day) return fmt::format("{:.1f} days", seconds / day);
  if (seconds >= hour) return fmt::format("{:.1f} h", seconds / hour);
  return fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

} // namespace

std::optional<std::string> CostWatch::look(double wall, double time, std::size_t beads,
                                           const RunStatistics& statistics) {
  if (wall < next_) return std::nullopt;
  next_ = 2 * wall;
  const Look now{.wall = wall,
                 .time = time,
                 .beads = beads,
                 .evaluations = statistics.evaluations,
                 .rejected = statistics.rejected,
                 .steps = statistics.steps};
  const Pace pace = pace_to(now);
  std::optional<std::string> text;
  const bool grows = first_ && pace.left > far_more * first_->left && pace.left > hour;
  if ((pace.left > day || grows) && pace.left > far_more * warned_) {
    text = warning(now, pace);
    warned_ = pace.left;
  }
  if (!first_) first_ = pace, first_beads_ = beads;
  last_ = now;
  return text;
}

CostWatch::Pace CostWatch::pace_to(const Look& now) const {
  const double wall = now.wall - last_.wall, time = now.time - last_.time;
  const auto steps = static_cast<double>(now.steps - last_.steps),
             rejected = static_cast<double>(now.rejected - last_.rejected),
             evaluations = static_cast<double>(now.evaluations - last_.evaluations);
  return {.left = wall * (end_time_ - now.time) / time,
          .step = time / std::max(steps, 1.0),
          .evaluation = wall / std::max(evaluations, 1.0),
          .rejected = rejected / std::max(steps + rejected, 1.0)};
}

// The reason is what has changed most since the first look; before the second one only numbers are known.
std::string CostWatch::warning(const Look& now, const Pace& pace) const {
  std::string why =
      fmt::format("{} beads, steps of {:.2g} s, {:.0f} % of the attempts rejected",
                  now.beads, pace.step, 100 * pace.rejected);
  if (first_) {
    const double shorter = first_->step / pace.step,
                 more = static_cast<double>(now.beads)
                        / static_cast<double>(std::max<std::size_t>(first_beads_, 1)),
                 dearer = pace.evaluation / first_->evaluation;
    if (const double most = std::max({shorter, more, dearer}); most > 1.5)
      why +=
          most == shorter
              ? fmt::format("; steps are {:.2g} times shorter than at first", most)
          : most == more
              ? fmt::format("; there are {:.2g} times as many beads as at first", most)
              : fmt::format("; an evaluation takes {:.2g} times as long as at first", most);
  }
  return fmt::format(
      "at t = {:.4g} s of {:.4g} s this run needs {} more at its present pace ({}). "
      "run.max_wall_time stops a run in time",
      now.time, end_time_, period(pace.left), why);
}

} // namespace ehdjet::cli
