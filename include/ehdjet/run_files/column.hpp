#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

/// How the values of a column are stored: as doubles, 64-bit counts or flags of one byte.
enum class ColumnType { real, count, flag };

/// What a data set is called and what is in it.
struct ColumnInfo {
  std::string name, unit, description;
  ColumnType type = ColumnType::real;
};

/// A one-dimensional data set of a run file. It only grows.
///
/// Rows are collected in memory and written one chunk at a time; `flush` writes the incomplete
/// chunk as well, and writes it again when it has grown. Nothing is allocated after the start.
/// Rows may be appended only within `RunFile::write`, which knows what to do if that fails.
class Column {
public:
  struct DataSet; // HDF5 stays inside src/run_files
  Column(std::unique_ptr<DataSet> dataset, ColumnType type, std::size_t chunk_rows);
  ~Column();

  /// Counts are exact up to 2^53.
  void append(double value);
  void append(std::span<const double> values);
  void flush();

private:
  void append_bytes(const void* values, std::size_t rows);
  void write_chunk();

  std::unique_ptr<DataSet> dataset_;
  ColumnType type_;
  std::size_t row_size_, chunk_rows_;
  std::size_t first_ = 0;   ///< row of the data set where the chunk in memory begins
  std::size_t rows_ = 0;    ///< of that chunk
  std::size_t written_ = 0; ///< of those
  std::vector<unsigned char> chunk_;
};

} // namespace ehdjet
