#pragma once

#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/column.hpp"
#include "ehdjet/run_files/run_table.hpp"

#include <functional>
#include <memory>
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
/// Of beads with these columns, and `stress` in any case.
std::vector<RecordColumn<DepositedBead>>
deposit_columns(std::shared_ptr<const BeadTable> table);
std::vector<RecordColumn<RefinementRecord>> refinement_columns();

/// A number that each bead of a frame has.
struct FrameColumn : ColumnInfo {
  std::function<std::span<const double>(const JetSnapshot&)> values;
};

/// The columns of /beads, in the order of an export.
std::vector<FrameColumn> frame_columns(const BeadTable& table);
/// The columns of beads that every export has, also that of a run without stress.
std::shared_ptr<const BeadTable> exported_table();
/// What a frame has besides `frame_columns(*exported_table())`.
std::vector<RunTable::Column> further_columns(const Frame& frame);

} // namespace ehdjet
