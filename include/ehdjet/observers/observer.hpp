#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/schedule.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <limits>
#include <memory>
#include <span>
#include <string>

namespace ehdjet {

class DenseStep;
class Event;

/// The jet at one instant. The nozzle bead and an embryo are at their prescribed places.
struct JetSnapshot {
  double time = 0;                  ///< [s]
  JetColumns<const double> columns; ///< at `time`
  const JetState& jet;              ///< the chain; its own columns may be at another time
  const Ledger& ledger;
  const RunStatistics& statistics;
};

/// The calls that an observer needs besides those at its own times. A simulation makes only the
/// calls that some observer needs.
struct Interest {
  bool ends_of_steps = false;    ///< after_step
  bool steps_and_events = false; ///< begin_step, end_step, before_event, after_event
};

/// Observes the jet without changing it: a run gives the same bits with and without observers. A
/// function that is not overridden does nothing. Each function may throw to end the run.
class Observer {
public:
  virtual ~Observer();

  /// The next time at which `observe` is called, or infinity [s].
  [[nodiscard]] virtual double next_time() const {
    return std::numeric_limits<double>::infinity();
  }
  /// Called with the jet at `next_time()`, after the events at that time. Between the ends of steps
  /// the state comes from the dense output.
  virtual void observe(const JetSnapshot& /*snapshot*/) {}
  /// Called when the run continues from a checkpoint: `next_time` must not be before `time` [s].
  virtual void skip_to(double /*time*/) {}
  /// What its next calls depend on, under a name of its own in `a`. It is read after `skip_to`, from the
  /// checkpoint of a run that may not have had this observer.
  virtual void archive(const Archive& /*a*/) {}
  /// Called when a bead has left the chain.
  virtual void deposit(const DepositedBead& /*bead*/) {}
  /// Called after a refinement, if the run records refinements.
  virtual void refined(const RefinementRecord& /*record*/) {}
  /// Called with everything that is needed to continue the run, if the run makes checkpoints.
  virtual void checkpoint(const Checkpoint& /*checkpoint*/) {}

  /// Called once, when the observer is added.
  [[nodiscard]] virtual Interest interest() const { return {}; }
  /// Called when a step has been accepted, before observers see it and before its events. `step` and
  /// `events` are valid until `end_step`.
  virtual void begin_step(const DenseStep& /*step*/,
                          std::span<const std::unique_ptr<Event>> /*events*/) {}
  /// Called when the part of the step up to `theta` is complete. The time is t [s].
  virtual void end_step(double /*t*/, double /*theta*/) {}
  /// Called before and after an event, with the jet at the time of the event.
  virtual void before_event(const Event& /*event*/, const JetState& /*jet*/) {}
  virtual void after_event(const Event& /*event*/, const JetState& /*jet*/) {}
  /// Called at the end of a step, after its events and its checkpoint.
  virtual void after_step(const JetSnapshot& /*snapshot*/) {}
};

/// Named quantities of a jet, for observers that write tables of them.
class Accounts {
public:
  struct Column {
    std::string name, unit, description;
  };
  virtual ~Accounts() = default;
  [[nodiscard]] virtual std::span<const Column> columns() const = 0;
  /// Sets row (columns) to the values at the time of the snapshot. Successive times must not
  /// decrease.
  virtual void measure(const JetSnapshot& snapshot, std::span<double> row) = 0;
};

} // namespace ehdjet
