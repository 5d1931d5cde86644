#include "ehdjet/run_files/run_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "file_driver.hpp"
#include "hdf5.hpp"

namespace ehdjet {
namespace {

struct ChunkPlace {
  haddr_t address = HADDR_UNDEF;
  hsize_t size = 0;
};

// The place in the file of the chunk that begins at row `first`.
ChunkPlace place_of_chunk(hid_t dataset, hsize_t first) {
  ChunkPlace place;
  unsigned mask = 0;
  hdf5::check(
      H5Dget_chunk_info_by_coord(dataset, &first, &mask, &place.address, &place.size));
  return place;
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

Column::Column(const hdf5::Handle& group, const ColumnInfo& info, std::size_t chunk_rows)
    : dataset_(std::make_unique<hdf5::Handle>(hdf5::create_rows(
        group, info.name.c_str(), native(info.type), chunk_rows, hdf5::Packing::deflate)))
    , type_(info.type)
    , row_size_(type_ == ColumnType::flag ? 1 : 8)
    , chunk_rows_(chunk_rows)
    , chunk_(chunk_rows * row_size_) {
  hdf5::write_attribute(*dataset_, "unit", info.unit);
  hdf5::write_attribute(*dataset_, "units", info.unit); // so called by netCDF and xarray
  hdf5::write_attribute(*dataset_, "description", info.description);
  if (info.scale == info.name)
    hdf5::make_scale(*dataset_, info.name.c_str());
  else if (hdf5::has(group, info.scale.c_str()))
    hdf5::attach_scale(*dataset_, group, info.scale.c_str());
}

Column::~Column() = default;

void Column::append(double value) {
  const auto store = [&](auto stored) { append_bytes(&stored, 1); };
  if (type_ == ColumnType::real)
    store(value);
  else if (type_ == ColumnType::count)
    store(static_cast<std::uint64_t>(value));
  else
    store(static_cast<std::uint8_t>(value));
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
    if (const std::size_t chunks = rows / chunk_rows_; rows_ == 0 && chunks > 1) {
      append_chunks(from, chunks);
      from += chunks * chunk_.size(), rows -= chunks * chunk_rows_;
      continue;
    }
    const std::size_t part = std::min(rows, chunk_rows_ - rows_);
    std::memcpy(chunk_.data() + rows_ * row_size_, from, part * row_size_);
    from += part * row_size_, rows -= part, rows_ += part;
    if (rows_ < chunk_rows_) continue;
    write_chunk();
    first_ += chunk_rows_, rows_ = written_ = 0;
  }
}

// The library packs one chunk at a time, which takes longer than an evaluation for many beads.
void Column::append_chunks(const unsigned char* values, std::size_t chunks) {
  constexpr std::size_t at_once = 32;
  std::vector<hdf5::PackedChunk> packed(std::min(chunks, at_once),
                                        hdf5::PackedChunk(chunk_.size()));
  for (std::size_t done = 0; done < chunks; done += packed.size()) {
    const std::size_t count = std::min(packed.size(), chunks - done);
    const unsigned char* from = values + done * chunk_.size();
    bool failed = false;
#pragma omp parallel for schedule(dynamic) reduction(|| : failed)
    for (std::size_t k = 0; k < count; ++k)
      failed = !packed[k].pack(from + k * chunk_.size(), row_size_) || failed;
    if (failed) throw hdf5::Failure("cannot deflate a chunk");
    for (std::size_t k = 0; k < count; ++k) {
      const hsize_t end = first_ + chunk_rows_;
      hdf5::check(H5Dset_extent(*dataset_, &end));
      packed[k].write(*dataset_, first_);
      first_ += chunk_rows_;
    }
  }
}

void Column::flush() {
  if (rows_ > written_) write_chunk();
}

void Column::write_chunk() {
  const hdf5::Handle& dataset = *dataset_;
  const ChunkPlace old = written_ > 0 ? place_of_chunk(dataset, first_) : ChunkPlace{};
  const hsize_t end = first_ + rows_;
  hdf5::check(H5Dset_extent(dataset, &end));
  hdf5::write_rows(dataset, native(type_), first_, rows_, chunk_.data());
  if (written_ > 0 && place_of_chunk(dataset, first_).address != old.address) {
    // HDF5 does not keep the old place of a chunk that has moved.
    const hdf5::Handle file(H5Iget_file_id(dataset), H5Fclose);
    hdf5::FileDriver::of(file).release(old.address, old.size);
  }
  written_ = rows_;
}

} // namespace ehdjet
