#include "column.hpp"

#include <algorithm>

#include "file_driver.hpp"

namespace ehdjet::hdf5 {

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

Handle create(hid_t group, const char* name, hid_t type, hsize_t chunk) {
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

} // namespace

Column::Column(hid_t group, const ColumnInfo& info, hid_t type, std::size_t row_size,
               std::size_t chunk_rows)
    : dataset_(create(group, info.name, type, chunk_rows))
    , type_(type)
    , row_size_(row_size)
    , chunk_rows_(chunk_rows)
    , chunk_(chunk_rows * row_size) {
  write_attribute(dataset_, "unit", std::string(info.unit));
  write_attribute(dataset_, "description", std::string(info.description));
}

void Column::append_bytes(const void* values, std::size_t rows) {
  const auto* from = static_cast<const unsigned char*>(values);
  while (rows > 0) {
    const std::size_t part = std::min<std::size_t>(rows, chunk_rows_ - rows_);
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
  const Stretch old = written_ > 0 ? place_of_chunk(dataset_, first_) : Stretch{};
  const hsize_t end = first_ + rows_;
  check(H5Dset_extent(dataset_, &end));
  const Handle space(H5Dget_space(dataset_), H5Sclose);
  const Handle memory(H5Screate_simple(1, &rows_, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first_, nullptr, &rows_, nullptr));
  check(H5Dwrite(dataset_, type_, memory, space, H5P_DEFAULT, chunk_.data()));
  if (written_ > 0 && place_of_chunk(dataset_, first_).address != old.address) {
    // HDF5 forgets where the chunk was before it grew.
    const Handle file(H5Iget_file_id(dataset_), H5Fclose);
    FileDriver::of(file).release(old.address, old.size);
  }
  written_ = rows_;
}

} // namespace ehdjet::hdf5
