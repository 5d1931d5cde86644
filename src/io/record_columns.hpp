#pragma once

#include "ehdjet/jet/bead_range.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/array_observer.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

/// The parts of a run file as lists of columns. Observers that write them and exports that read
/// them use these lists: a new column is a new line in one list.
namespace ehdjet {

/// A column of a part that has one row per `Row`: an output time, a deposited bead or a refinement.
/// A value may depend on earlier rows; each writer therefore has its own list.
template <class Row>
struct RecordColumn : ColumnInfo {
  std::function<double(const Row&)> value;
  /// What the values of later rows depend on; empty if nothing.
  std::function<void(const Archive&)> archive = {};
};

/// Archives the columns of a part of a run file.
template <class Row>
void archive(const Archive& a, const char* part,
             const std::vector<RecordColumn<Row>>& columns) {
  const Archive own = a.part(part);
  if (a.is_reading() && own.names().empty()) return;
  for (const auto& c : columns)
    if (c.archive) c.archive(own.part(c.name));
}

std::vector<RecordColumn<JetSnapshot>> observable_columns();
/// The same names for all jets of an array: sums, means and largest values, as their descriptions say.
std::vector<RecordColumn<ArraySnapshot>> array_observable_columns();
/// The jet that a bead, a deposited bead or a refinement belongs to, in runs of an array.
[[nodiscard]] ColumnInfo jet_column();
/// For beads that have the columns of `table`. The deposit always has a column `stress`.
std::vector<RecordColumn<DepositedBead>>
deposit_columns(std::shared_ptr<const BeadTable> table);
/// Of deposited links, from the volume that they have when they leave the chain [m].
std::vector<double> link_lengths(const RunTable& deposit);
std::vector<RecordColumn<RefinementRecord>> refinement_columns();

/// A value that each bead of a frame has.
struct FrameColumn : ColumnInfo {
  std::function<std::span<const double>(const JetSnapshot&)> values;
};

/// The columns of /beads, in the order of an export.
std::vector<FrameColumn> frame_columns(const BeadTable& table);
/// The columns of beads that every export has, even if the run has no stress.
std::shared_ptr<const BeadTable> exported_table();
/// The columns of a frame that are not in `frame_columns(*exported_table())`.
std::vector<RunTable::Column> further_columns(const Frame& frame);
/// The rows of each jet of a frame: one range, unless the run has an array.
std::vector<BeadRange> jets_of(const RunTable& frame);
/// A column of a frame, or zeros if the frame does not have it.
std::vector<double> column_or_zeros(const RunTable& frame, std::string_view name);

} // namespace ehdjet
