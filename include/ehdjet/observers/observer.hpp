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
#include <vector>

namespace ehdjet {

class DenseStep;
class Event;

/// The jet at one instant, prescribed beads (nozzle, embryo) in their places.
struct JetSnapshot {
  double time = 0;                  ///< [s]
  JetColumns<const double> columns; ///< at `time`
  const JetState& jet;              ///< the chain the columns belong to; not its y
  const Ledger& ledger;
  const RunStatistics& statistics;
};

/// Which calls beside those at times of its own an observer wants. A simulation in which nobody
/// wants them does not make them.
struct Interest {
  bool ends_of_steps = false;    ///< after_step
  bool steps_and_events = false; ///< begin_step, end_step, before_event, after_event
};

/// Looks at the jet and never changes it: a run gives the same jet, bit for bit, with or without
/// observers. Every function does nothing unless it is overridden. Any of them may throw to end
/// the run.
class Observer {
public:
  virtual ~Observer();

  /// Next time at which this observer wants to see the jet; infinity for never [s].
  [[nodiscard]] virtual double next_time() const {
    return std::numeric_limits<double>::infinity();
  }
  /// The jet at `next_time()`, after any event at that same time. A state between two steps is
  /// read off the dense output.
  virtual void observe(const JetSnapshot& /*snapshot*/) {}
  /// The run goes on from a checkpoint: times before it have been seen to.
  virtual void skip_to(double /*time*/) {}
  /// A bead has left the chain.
  virtual void deposit(const DepositedBead& /*bead*/) {}
  /// The chain has been cut anew; only if the run records refinements.
  virtual void refined(const RefinementRecord& /*record*/) {}
  /// All that the run needs to go on from here later; only if the run makes checkpoints.
  virtual void checkpoint(const Checkpoint& /*checkpoint*/) {}

  /// Asked once, when the observer is added.
  [[nodiscard]] virtual Interest interest() const { return {}; }
  /// A step has been accepted; observers have not been shown any of it, events not been applied.
  /// `step` and `events` may be looked at until `end_step`.
  virtual void begin_step(const DenseStep& /*step*/,
                          std::span<const std::unique_ptr<Event>> /*events*/) {}
  /// The step up to `theta` has become the past, the time is t [s].
  virtual void end_step(double /*t*/, double /*theta*/) {}
  /// The jet before and after an event, both at its time.
  virtual void before_event(const Event& /*event*/, const JetState& /*jet*/) {}
  virtual void after_event(const Event& /*event*/, const JetState& /*jet*/) {}
  /// The jet at the end of a step, after its events and its checkpoint.
  virtual void after_step(const JetSnapshot& /*snapshot*/) {}
};

/// Numbers about a jet under given names, for those who write tables and need not know more.
class Accounts {
public:
  struct Column {
    std::string name, unit, description;
  };
  virtual ~Accounts() = default;
  [[nodiscard]] virtual std::span<const Column> columns() const = 0;
  /// row (columns): at the time of the snapshot, which must not lie before the last one.
  virtual void measure(const JetSnapshot& snapshot, std::span<double> row) = 0;
};

} // namespace ehdjet
