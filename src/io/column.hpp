#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "hdf5.hpp"

namespace ehdjet::hdf5 {

/// What a data set is called and what is in it.
struct ColumnInfo {
  const char* name;
  const char* unit;
  const char* description;
};

/// A one-dimensional data set that only grows.
///
/// Rows are collected in memory and written one chunk at a time; `flush` writes the incomplete
/// chunk as well, and writes it again when it has grown. Nothing is allocated after the start.
class Column {
public:
  /// `row` is any value of the row's type: double, uint64 or uint8.
  template <class T>
  Column(hid_t group, const ColumnInfo& info, T /*row*/, std::size_t chunk_rows)
      : Column(group, info, native(T{}), sizeof(T), chunk_rows) {}

  template <class T>
  void append(T value) {
    append_bytes(&value, 1);
  }
  template <class T>
  void append(std::span<const T> values) {
    append_bytes(values.data(), values.size());
  }
  void flush();

private:
  Column(hid_t group, const ColumnInfo& info, hid_t type, std::size_t row_size,
         std::size_t chunk_rows);
  void append_bytes(const void* values, std::size_t rows);
  void write_chunk();

  Handle dataset_;
  hid_t type_;
  std::size_t row_size_;
  hsize_t chunk_rows_;
  hsize_t first_ = 0;   ///< row of the data set where the chunk in memory begins
  hsize_t rows_ = 0;    ///< of that chunk
  hsize_t written_ = 0; ///< of those
  std::vector<unsigned char> chunk_;
};

} // namespace ehdjet::hdf5
