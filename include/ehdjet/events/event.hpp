#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/events/dense_step.hpp"
#include "ehdjet/jet/exchange.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// What an event may change.
struct EventContext {
  JetState& jet; ///< at the time of the event, prescribed beads in their places
  Ledger& ledger;
  RunStatistics& statistics;
  std::vector<DepositedBead>& deposited;  ///< receives beads that leave the chain
  std::vector<RefinementRecord>& refined; ///< receives what a refinement did
};

/// Something that happens to the chain: at the root of a continuous function of the state (model 4
/// and 5) or at a given time, located inside a step on the dense output.
class Event {
public:
  virtual ~Event() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// What the event changes at once has this channel in a budget (model 8).
  [[nodiscard]] virtual Channel channel() const {
    return Channel::named(std::string(name()));
  }

  /// Whether the state calls for the event now: at the end of a step (events = "step-end"), or
  /// right after another event at the same instant.
  [[nodiscard]] virtual bool due(const JetState& jet) const = 0;

  /// First theta in (0, 1] at which the event happens and must end the step, if it does.
  [[nodiscard]] virtual std::optional<double> locate(const DenseStep& step) = 0;

  /// Another event has ended the step at `time`: what was located behind that has not happened.
  virtual void overtaken(double /*time*/) {}

  /// The first time after t at which a step must end because the event may happen then [s].
  [[nodiscard]] virtual double next_time(double /*t*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// The exact time of an event that was located and that happens at given times [s].
  [[nodiscard]] virtual std::optional<double> scheduled_time() const { return {}; }

  /// When the event may be expected, from the step just made: theta > 1, a guess for the choice
  /// of the next step size only.
  [[nodiscard]] virtual std::optional<double> predict(const DenseStep& step) const = 0;

  /// What has happened to the chain by time t inside a step that the event does not end, for those
  /// who look: done to `jet`, a copy at that time.
  virtual void anticipate(double /*t*/, JetState& /*jet*/) const {}

  /// When that happened: appends the times inside the step at which `anticipate` changes the
  /// chain [s].
  virtual void list_inner_times(std::vector<double>& /*times*/) const {}

  /// Changes the chain. Called at a located time or when due.
  virtual void apply(EventContext& context) = 0;

  /// The motion right after the event has another time scale than before it: the next step size
  /// is the one that suited after the last event of this kind, not the last step's proposal.
  [[nodiscard]] virtual bool restarts_motion() const { return false; }

  /// Whether it only takes beads off the end of the chain that did not move any more.
  [[nodiscard]] virtual bool leaves_motion() const { return false; }

  /// What the event remembers between steps.
  virtual void archive(const Archive& /*a*/) {}
};

} // namespace ehdjet
