#pragma once

#include "ehdjet/jet/ledger.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace ehdjet::cli {

/// Notices when the cost of a run runs away: when it would take days, or when the time left has grown to a
/// multiple although the run went on.
class CostWatch {
public:
  /// `time`: where the run starts [s]; `statistics`: those with which it starts, of a run that goes on those of its
  /// first part.
  CostWatch(double time, double end_time, std::size_t beads,
            const RunStatistics& statistics)
      : end_time_(end_time)
      , last_{.wall = 0,
              .time = time,
              .beads = beads,
              .evaluations = statistics.evaluations,
              .rejected = statistics.rejected,
              .steps = statistics.steps} {}

  /// Call after each step, with the wall time since the start [s]. Returns a warning, at most once in a doubling
  /// of the wall time.
  std::optional<std::string> look(double wall, double time, std::size_t beads,
                                  const RunStatistics& statistics);

private:
  /// Where the run was at a look.
  struct Look {
    double wall, time; // [s]
    std::size_t beads;
    std::uint64_t evaluations, rejected, steps;
  };
  /// The stretch between two looks.
  struct Pace {
    double left;       // wall time to the end of the run [s]
    double step;       // mean [s]
    double evaluation; // wall time of one [s]
    double rejected;   // share of the attempts
  };
  [[nodiscard]] Pace pace_to(const Look& now) const;
  [[nodiscard]] std::string warning(const Look& now, const Pace& pace) const;

  double end_time_;
  double next_ = first_look;
  double warned_ = 0; // of which time left [s]
  Look last_;
  std::optional<Pace> first_;
  std::size_t first_beads_ = 0;
  static constexpr double first_look = 10; // [s]
};

} // namespace ehdjet::cli
