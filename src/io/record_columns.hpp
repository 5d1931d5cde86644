#pragma once

#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/column.hpp"

#include <functional>
#include <span>
#include <vector>

namespace ehdjet {

// The parts of a run file as lists of columns. Observers that write, and exports, go through them;
// a new column is a new line in one of them.

/// A column of a part that has a row per `Row`: a time, a deposited bead or a refinement. A value
/// may depend on earlier rows, so that each writer has a list of its own.
template <class Row>
struct RecordColumn : ColumnInfo {
  std::function<double(const Row&)> value;
};

std::vector<RecordColumn<JetSnapshot>> observable_columns();
std::vector<RecordColumn<DepositedBead>> deposit_columns();
std::vector<RecordColumn<RefinementRecord>> refinement_columns();

/// A number that each bead has: in a frame, one per bead; at its landing, if the deposit has it.
struct BeadColumn : ColumnInfo {
  std::function<std::span<const double>(const JetSnapshot&)> values;
  const char* deposited = nullptr; ///< description in the deposit
  std::function<double(const Bead&)> landed_value;
};

/// The columns of /beads, in the order of an export.
std::vector<BeadColumn> bead_columns();

} // namespace ehdjet
