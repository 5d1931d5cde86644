#pragma once

#include "ehdjet/core/schedule.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

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
  /// A bead has left the chain.
  virtual void deposit(const DepositedBead& /*bead*/) {}
  /// The chain has been cut anew; only if the run records refinements.
  virtual void refined(const RefinementRecord& /*record*/) {}
};

} // namespace ehdjet
