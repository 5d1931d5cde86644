#include "hdf5.hpp"

#include <memory>
#include <zlib.h>

namespace ehdjet::hdf5 {
namespace {

constexpr int deflate_level = 4;

herr_t keep_description(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

Handle scalar() {
  return {H5Screate(H5S_SCALAR), H5Sclose};
}

void write_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  const bool exists = has_attribute(object, name);
  const Handle attribute(
      exists ? H5Aopen(object, name, H5P_DEFAULT)
             : H5Acreate2(object, name, type, scalar(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  check(H5Awrite(attribute, type, value));
}

// `read` stores a text that HDF5 has allocated.
template <class Read>
std::string text_from(const Read& read) {
  char* text = nullptr;
  check(read(&text));
  const std::unique_ptr<char, herr_t (*)(void*)> owner(text, H5free_memory);
  return text != nullptr ? text : "";
}

// The part of a one-dimensional data set that is read or written.
struct Rows {
  Handle file, memory;
  Rows(hid_t dataset, hsize_t first, hsize_t rows)
      : file(H5Dget_space(dataset), H5Sclose)
      , memory(H5Screate_simple(1, &rows, nullptr), H5Sclose) {
    check(H5Sselect_hyperslab(file, H5S_SELECT_SET, &first, nullptr, &rows, nullptr));
  }
};

} // namespace

void fail() {
  std::string description = "unknown HDF5 error"; // the innermost call names the cause
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_description, &description);
  throw Failure(description);
}

Handle::Handle(hid_t id, Close close)
    : id_(id)
    , close_(close) {
  if (id < 0) fail();
}

void Handle::reset() {
  if (id_ >= 0) close_(id_);
  id_ = H5I_INVALID_HID;
}

void silence_errors() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Handle string_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, H5T_VARIABLE));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

void keep_in_one_record(hid_t creation_properties) {
  check(H5Pset_link_phase_change(creation_properties, 64, 32));
  check(H5Pset_attr_phase_change(creation_properties, 64, 32));
}

Handle create_group(hid_t parent, const char* name) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  keep_in_one_record(properties);
  return {H5Gcreate2(parent, name, H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose};
}

bool has(hid_t parent, const char* name) {
  return check(H5Lexists(parent, name, H5P_DEFAULT)) > 0;
}

void write_attribute(hid_t object, const char* name, const std::string& value) {
  const char* text = value.c_str();
  write_attribute(object, name, string_type(), &text);
}
void write_attribute(hid_t object, const char* name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}
void write_attribute(hid_t object, const char* name, std::uint64_t value) {
  write_attribute(object, name, H5T_NATIVE_UINT64, &value);
}

void write_text(hid_t group, const char* name, const std::string& value) {
  const char* text = value.c_str();
  const Handle type = string_type();
  const Handle dataset(
      H5Dcreate2(group, name, type, scalar(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text));
}

bool has_attribute(hid_t object, const char* name) {
  return check(H5Aexists(object, name)) > 0;
}

std::string read_text_attribute(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  return text_from([&](char** text) { return H5Aread(attribute, string_type(), text); });
}

std::uint64_t read_count_attribute(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  std::uint64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_UINT64, &value));
  return value;
}

std::string read_text(hid_t group, const char* name) {
  const Handle dataset(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  return text_from([&](char** text) {
    return H5Dread(dataset, string_type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
  });
}

Handle create_rows(hid_t group, const char* name, hid_t type, hsize_t chunk_rows,
                   Packing packing) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  check(H5Pset_chunk(properties, 1, &chunk_rows));
  check(H5Pset_obj_track_times(properties, false)); // the same run gives the same bytes
  if (packing == Packing::deflate) {
    check(H5Pset_shuffle(properties));
    check(H5Pset_deflate(properties, deflate_level));
    check(H5Pset_chunk_cache(access, 0, 0, 1)); // Column keeps the chunk in memory
  }
  return {H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, access), H5Dclose};
}

hsize_t length(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  return static_cast<hsize_t>(check(H5Sget_simple_extent_npoints(space)));
}

PackedChunk::PackedChunk(std::size_t bytes)
    : shuffled_(bytes)
    , packed_(::compressBound(bytes)) {}

// The filters of the data set: first bytes of all rows, second bytes of all rows, ..., deflated.
bool PackedChunk::pack(const unsigned char* rows, std::size_t row_size) {
  const std::size_t count = shuffled_.size() / row_size;
  for (std::size_t byte = 0; byte < row_size; ++byte)
    for (std::size_t i = 0; i < count; ++i)
      shuffled_[byte * count + i] = rows[i * row_size + byte];
  uLongf size = packed_.size();
  const int status =
      ::compress2(packed_.data(), &size, shuffled_.data(), shuffled_.size(), deflate_level);
  size_ = size;
  return status == Z_OK;
}

void PackedChunk::write(hid_t dataset, hsize_t first) const {
  check(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, &first, size_, packed_.data()));
}

void write_rows(hid_t dataset, hid_t type, hsize_t first, hsize_t rows,
                const void* values) {
  const Rows part(dataset, first, rows);
  check(H5Dwrite(dataset, type, part.memory, part.file, H5P_DEFAULT, values));
}

template <class T>
std::vector<T> read_rows(hid_t dataset, hsize_t first, hsize_t rows) {
  std::vector<T> values(rows);
  if (rows == 0) return values;
  const Rows part(dataset, first, rows);
  check(H5Dread(dataset, native(T{}), part.memory, part.file, H5P_DEFAULT, values.data()));
  return values;
}
template std::vector<double> read_rows(hid_t, hsize_t, hsize_t);
template std::vector<std::uint64_t> read_rows(hid_t, hsize_t, hsize_t);
template std::vector<std::uint8_t> read_rows(hid_t, hsize_t, hsize_t);

} // namespace ehdjet::hdf5
