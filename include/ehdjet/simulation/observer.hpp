#pragma once

#include "ehdjet/core/schedule.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <cstddef>
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

/// Looks at the jet and never changes it: a run gives the same jet, bit for bit, with or
/// without observers. States between steps are read off the dense output.
class Observer {
public:
  virtual ~Observer() = default;

  /// Next time at which this observer wants to see the jet; infinity for never [s].
  [[nodiscard]] virtual double next_time() const {
    return std::numeric_limits<double>::infinity();
  }
  /// The jet at `next_time()`, after any event at that same time.
  virtual void observe(const JetSnapshot& /*snapshot*/) {}
  /// The run goes on from a checkpoint: times before it have been seen to.
  virtual void skip_to(double /*time*/) {}
  /// A bead has left the chain.
  virtual void deposit(const DepositedBead& /*bead*/) {}
  /// The chain has been cut anew; only if the run records refinements.
  virtual void refined(const RefinementRecord& /*record*/) {}
};

/// Sees every step and every event, for what has to be added up over all of a run. Steps of a
/// simulation that has none of these make no call.
class StepObserver {
public:
  virtual ~StepObserver() = default;

  /// A step has been accepted; observers have not been shown any of it, events not been applied.
  /// `step` and `events` may be looked at until `end_step`.
  virtual void begin_step(const DenseStep& step,
                          std::span<const std::unique_ptr<Event>> events) = 0;
  /// The step up to `theta` has become the past, the time is t [s].
  virtual void end_step(double t, double theta) = 0;
  /// The jet before and after an event, both at its time.
  virtual void before_event(const Event& event, const JetState& jet) = 0;
  virtual void after_event(const Event& event, const JetState& jet) = 0;
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
