#pragma once

#include "ehdjet/core/error.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// What the loops over steps of a jet and of an array have in common.
namespace ehdjet {

inline constexpr double never = std::numeric_limits<double>::infinity();
/// An expected event lies inside the step that aims at it, not just behind its end.
inline constexpr double aim_beyond = 1.02;
/// A wanted step that ends so close before the end of a run goes to the end: no remainder of round-off
/// size is left.
inline constexpr double nearly = 1 - 1e-9;

class WallClock {
public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Who cannot write knows what failed, but not when.
template <class Write>
void at_time(double t, const Write& write) {
  try {
    write();
  } catch (const RunError& e) {
    throw RunError(fmt::format("at t = {:.9g} s: {}", t, e.what()));
  }
}

/// The first multiple of `interval` after t [s]. It follows from the time alone, also in a run that goes
/// on from a checkpoint.
double next_multiple(double interval, double t);

/// When a run to `end` shows what is due at `time`, a multiple of an interval: at the end, if it lies beyond
/// only by round-off, as 3*1e-5 lies beyond 3e-5; never, if it is later [s].
std::optional<double> output_time(double time, double end);

/// What a checkpoint says about observers stands in this part of it.
inline constexpr std::string_view observers_part = "observers";
/// One part of a checkpoint.
Checkpoint part_of(const Checkpoint& checkpoint, std::string_view name);

/// The beads of the start count as inserted.
Ledger ledger_at_start(const JetState& jet);

using Events = std::span<const std::unique_ptr<Event>>;
struct FoundEvent {
  std::size_t index;
  double theta;
};
/// Counts an accepted step of length h [s].
void count_step(RunStatistics& statistics, double h);
/// Notes the method of a step that began at t [s], where the methods of a run change.
void note_method(RunStatistics& statistics, std::string_view in_use, double t);

/// The first of the events inside a step, of those at the same instant the first in their order.
std::optional<FoundEvent> first_event(Events events, const DenseStep& step);
/// When the next event may be expected after a step [s].
double expected_time(Events events, const DenseStep& step);

/// Brings what bead 1 carries to the time of the jet.
void feed(const JetDynamics& dynamics, JetState& jet, Ledger& ledger);

/// A bead that runs into its upstream neighbour, closer than `shortest` [m], in a step to the state
/// `end`, between whose ends beads are taken to fly straight. Those that rest or have passed the
/// collector do not count.
std::optional<std::size_t> vanishing_link(const JetState& jet, std::span<const double> end,
                                          double shortest);
/// What to tell the user about it.
std::string vanishing_text(const JetState& jet, JetDynamics& dynamics, double h,
                           std::size_t bead, double shortest);

} // namespace ehdjet
