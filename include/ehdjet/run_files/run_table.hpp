#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// Columns of equal length by their names, as a run file has them. SI units; counts and flags are
/// numbers too, exact up to 2^53.
struct RunTable {
  struct Column {
    std::string name, unit;
    std::vector<double> values;
  };
  std::vector<Column> columns;

  [[nodiscard]] std::size_t rows() const {
    return columns.empty() ? 0 : columns.front().values.size();
  }
  /// None if there is no column of that name.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// errors : InputError if there is no column of that name
  [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const;
};

/// The chain at one instant, bead 0 (the nozzle) first: the columns of /beads.
struct Frame : RunTable {
  double time = 0; ///< [s]
};

} // namespace ehdjet
