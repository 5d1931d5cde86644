#pragma once

#include "ehdjet/io/text_output.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ehdjet {

/// The times [s] over which observables are averaged; without ends, the second half of the times that
/// a run has recorded.
struct MeanWindow {
  std::optional<double> from, to;
};

/// One row per run, whatever they are. Columns are
///   run, status ("complete", "interrupted", "failed", "running", "unreadable"), message;
///   every key of the scene that is not the same in all runs, with its unit: viscoelasticity.viscosity_pa_s;
///   from_s, to_s, rows: the times of the means, and their number;
///   mean and standard error of every observable: path_length_m, path_length_error_m;
///   cost: evaluations, steps, ... and wall_time_s.
struct GatheredRuns {
  /// No value: the run does not have it.
  using Cell = std::variant<std::monostate, double, std::string>;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;

  void print_csv(TextOutput& output) const;
  void print_json(TextOutput& output) const; ///< a list with an object per run
};

/// Reads run files. A file that cannot be read is a row with the reason.
GatheredRuns gather_runs(const std::vector<std::filesystem::path>& files,
                         const MeanWindow& window = {});

} // namespace ehdjet
