#pragma once

#include "ehdjet/run_files/column.hpp"

#include <cstddef>

#include "hdf5.hpp"

namespace ehdjet {

struct Column::DataSet {
  hdf5::Handle handle;
  hid_t type; ///< of a row in memory

  static std::unique_ptr<DataSet> create(hid_t group, const ColumnInfo& info,
                                         std::size_t chunk_rows);
};

} // namespace ehdjet
