#include "ehdjet/run_files/column.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "data_set.hpp"
#include "file_driver.hpp"

namespace ehdjet {

using hdf5::check;
using hdf5::Handle;

namespace {

struct Stretch {
  haddr_t address = HADDR_UNDEF;
  hsize_t size = 0;
};

// Where the chunk that begins at row `first` lies in the file.
Stretch place_of_chunk(hid_t dataset, hsize_t first) {
  Stretch place;
  unsigned mask = 0;
  check(H5Dget_chunk_info_by_coord(dataset, &first, &mask, &place.address, &place.size));
  return place;
}

Handle create_data_set(hid_t group, const char* name, hid_t type, hsize_t chunk) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_chunk(properties, 1, &chunk));
  check(H5Pset_shuffle(properties));
  check(H5Pset_deflate(properties, 4));
  check(H5Pset_obj_track_times(properties, false)); // same run, same bytes
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  check(H5Pset_chunk_cache(access, 0, 0, 1)); // the chunk in work is ours
  return {H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, access), H5Dclose};
}

hid_t native(ColumnType type) {
  switch (type) {
  case ColumnType::count:
    return hdf5::native(std::uint64_t{});
  case ColumnType::flag:
    return hdf5::native(std::uint8_t{});
  default:
    return hdf5::native(double{});
  }
}

} // namespace

std::unique_ptr<Column::DataSet>
Column::DataSet::create(hid_t group, const ColumnInfo& info, std::size_t chunk_rows) {
  const hid_t type = native(info.type);
  std::unique_ptr<DataSet> made(
      new DataSet{create_data_set(group, info.name.c_str(), type, chunk_rows), type});
  hdf5::write_attribute(made->handle, "unit", info.unit);
  hdf5::write_attribute(made->handle, "description", info.description);
  return made;
}

Column::Column(std::unique_ptr<DataSet> dataset, ColumnType type, std::size_t chunk_rows)
    : dataset_(std::move(dataset))
    , type_(type)
    , row_size_(type == ColumnType::flag ? 1 : 8)
    , chunk_rows_(chunk_rows)
    , chunk_(chunk_rows * row_size_) {}

Column::~Column() = default;

void Column::append(double value) {
  if (type_ == ColumnType::real) {
    append_bytes(&value, 1);
  } else if (type_ == ColumnType::count) {
    const auto count = static_cast<std::uint64_t>(value);
    append_bytes(&count, 1);
  } else {
    const auto flag = static_cast<std::uint8_t>(value);
    append_bytes(&flag, 1);
  }
}

void Column::append(std::span<const double> values) {
  if (type_ == ColumnType::real)
    append_bytes(values.data(), values.size());
  else
    for (const double value : values) append(value);
}

void Column::append_bytes(const void* values, std::size_t rows) {
  const auto* from = static_cast<const unsigned char*>(values);
  while (rows > 0) {
    const std::size_t part = std::min(rows, chunk_rows_ - rows_);
    std::memcpy(chunk_.data() + rows_ * row_size_, from, part * row_size_);
    from += part * row_size_, rows -= part, rows_ += part;
    if (rows_ < chunk_rows_) continue;
    write_chunk();
    first_ += chunk_rows_, rows_ = written_ = 0;
  }
}

void Column::flush() {
  if (rows_ > written_) write_chunk();
}

void Column::write_chunk() {
  const Handle& dataset = dataset_->handle;
  const hsize_t first = first_, rows = rows_, end = first + rows;
  const Stretch old = written_ > 0 ? place_of_chunk(dataset, first) : Stretch{};
  check(H5Dset_extent(dataset, &end));
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Handle memory(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &rows, nullptr));
  check(H5Dwrite(dataset, dataset_->type, memory, space, H5P_DEFAULT, chunk_.data()));
  if (written_ > 0 && place_of_chunk(dataset, first).address != old.address) {
    // HDF5 forgets where the chunk was before it grew.
    const Handle file(H5Iget_file_id(dataset), H5Fclose);
    hdf5::FileDriver::of(file).release(old.address, old.size);
  }
  written_ = rows_;
}

} // namespace ehdjet
