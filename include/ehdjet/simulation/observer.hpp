#pragma once

#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <cstddef>
#include <cstdint>
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
};

/// Multiples k*interval, k = 0, 1, ..., computed without accumulating round-off.
class Schedule {
public:
  explicit Schedule(double interval)
      : interval_(interval) {}
  [[nodiscard]] double next() const { return static_cast<double>(count_) * interval_; }
  void advance() { ++count_; }

private:
  double interval_; // [s]
  std::uint64_t count_ = 0;
};

} // namespace ehdjet
