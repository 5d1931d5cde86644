#include "hdf5.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <memory>
#include <type_traits>
#include <zlib.h>

namespace ehdjet::hdf5 {
namespace {

constexpr int deflate_level = 4;

herr_t keep_description(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

std::string description() {
  std::string text = "unknown HDF5 error"; // the innermost call names the cause
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_description, &text);
  return text;
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

std::string name_of(hid_t object) {
  std::array<char, 256> name{};
  return H5Iget_name(object, name.data(), name.size()) > 0 ? name.data() : "/?";
}

template <class Result>
Result expect(hid_t object, Result result) {
  if (result < 0) refuse(object, "is not what it should be (" + description() + ")");
  return result;
}

// `read` stores a text that HDF5 has allocated.
template <class Read>
std::string text_from(hid_t object, const Read& read) {
  char* text = nullptr;
  expect(object, read(&text));
  const std::unique_ptr<char, herr_t (*)(void*)> owner(text, H5free_memory);
  return text != nullptr ? text : "";
}

// Every link on the way must be to an object of this file, and not by the name of another link.
void refuse_links(hid_t parent, const std::string& path) {
  for (std::size_t end = 0; end < path.size(); ++end) {
    end = std::min(path.find('/', end), path.size());
    const std::string link = path.substr(0, end);
    H5L_info_t info{};
    if (H5Lget_info(parent, link.c_str(), &info, H5P_DEFAULT) < 0)
      refuse(parent, "has no " + link);
    if (info.type != H5L_TYPE_HARD)
      refuse(parent,
             fmt::format("has a link {} to another place, which is not followed", link));
  }
}

template <class Opened>
Handle open(hid_t parent, const std::string& path, const char* kind, Opened opened,
            Handle::Close close) {
  refuse_links(parent, path);
  const hid_t id = opened(parent, path.c_str(), H5P_DEFAULT);
  if (id < 0)
    refuse(parent, fmt::format("cannot be read: its {} is no readable {}", path, kind));
  return {id, close};
}

Handle open_data_set(hid_t parent, const std::string& path) {
  return open(parent, path, "data set", H5Dopen2, H5Dclose);
}

bool is_one_element(hid_t space) {
  return H5Sget_simple_extent_type(space) != H5S_NULL
         && H5Sget_simple_extent_npoints(space) == 1;
}

// Texts are of variable length, as this program and h5py write them.
void expect_text(hid_t object, const std::string& what, const Handle& space,
                 const Handle& type) {
  if (!is_one_element(space) || H5Tis_variable_str(type) <= 0)
    refuse(object, what + "is not one text");
}

// A few bytes can claim to be any number of rows. Deflate makes data at most about 1032 times shorter.
void expect_stored(hid_t dataset, std::uint64_t rows, std::uint64_t row_size) {
  constexpr std::uint64_t most_expansion = 1100, small = 1U << 22U;
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (H5Pget_external_count(properties) != 0 || layout == H5D_VIRTUAL)
    refuse(dataset, "has its numbers in another file, which is not read");
  if (layout == H5D_COMPACT) return;
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  const Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t file_size = 0;
  expect(dataset, H5Fget_filesize(file, &file_size));
  if (stored > file_size)
    refuse(dataset, fmt::format("claims {} bytes of a file of {}", stored, file_size));
  std::uint64_t chunk = 0, most = stored;
  if (layout == H5D_CHUNKED) {
    hsize_t chunk_rows = 0;
    expect(dataset, H5Pget_chunk(properties, 1, &chunk_rows));
    chunk = chunk_rows;
    most = rows > 0 && stored == 0 ? 0 : most_expansion * stored + small;
  }
  if (std::max(rows, rows == 0 ? 0 : chunk) > most / row_size)
    refuse(dataset, fmt::format("claims {} rows, but has only {} bytes", rows, stored));
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
  throw Failure(description());
}

void refuse(hid_t object, const std::string& reason) {
  throw Failure(name_of(object) + " " + reason);
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

void keep_no_times(hid_t creation_properties) {
  check(H5Pset_obj_track_times(creation_properties, false));
}

void keep_in_one_record(hid_t creation_properties) {
  check(H5Pset_link_phase_change(creation_properties, 64, 32));
  check(H5Pset_attr_phase_change(creation_properties, 64, 32));
}

Handle create_group(hid_t parent, const char* name) {
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  keep_in_one_record(properties);
  keep_no_times(properties);
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
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  keep_no_times(properties);
  const Handle dataset(
      H5Dcreate2(group, name, type, scalar(), H5P_DEFAULT, properties, H5P_DEFAULT),
      H5Dclose);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text));
}

bool has_attribute(hid_t object, const char* name) {
  return check(H5Aexists(object, name)) > 0;
}

Handle open_group(hid_t parent, const std::string& path) {
  return open(parent, path, "group", H5Gopen2, H5Gclose);
}

Handle open_rows(hid_t parent, const std::string& path) {
  Handle dataset = open_data_set(parent, path);
  const Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose);
  if (H5Sget_simple_extent_ndims(space) != 1)
    refuse(dataset, "is not a list: it is not one-dimensional");
  const H5T_class_t kind = H5Tget_class(type);
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Tget_size(type) > sizeof(double))
    refuse(dataset, "is not a list of numbers of at most 8 bytes");
  expect_stored(dataset, length(dataset), H5Tget_size(type));
  return dataset;
}

std::string read_text_attribute(hid_t object, const char* name) {
  const std::string what = fmt::format("has an attribute {} that ", name);
  if (!has_attribute(object, name))
    refuse(object, fmt::format("has no attribute {}", name));
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  expect_text(object, what, {H5Aget_space(attribute), H5Sclose},
              {H5Aget_type(attribute), H5Tclose});
  return text_from(object,
                   [&](char** text) { return H5Aread(attribute, string_type(), text); });
}

std::uint64_t read_count_attribute(hid_t object, const char* name) {
  if (!has_attribute(object, name))
    refuse(object, fmt::format("has no attribute {}", name));
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose),
      type(H5Aget_type(attribute), H5Tclose);
  if (!is_one_element(space) || H5Tget_class(type) != H5T_INTEGER
      || H5Tget_size(type) > sizeof(std::uint64_t))
    refuse(object, fmt::format("has an attribute {} that is not one whole number", name));
  std::uint64_t value = 0;
  expect(object, H5Aread(attribute, H5T_NATIVE_UINT64, &value));
  return value;
}

std::map<std::string, double> read_number_attributes(hid_t object) {
  std::map<std::string, double> numbers;
  const auto read = [](hid_t owner, const char* name, const H5A_info_t*, void* into) {
    const hid_t attribute = H5Aopen(owner, name, H5P_DEFAULT);
    if (attribute < 0) return herr_t{-1};
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    const H5T_class_t kind = H5Tget_class(type);
    double number = 0;
    herr_t result = 0;
    if ((kind == H5T_INTEGER || kind == H5T_FLOAT)
        && H5Sget_simple_extent_npoints(space) == 1) {
      result = H5Aread(attribute, H5T_NATIVE_DOUBLE, &number);
      if (result >= 0) (*static_cast<std::map<std::string, double>*>(into))[name] = number;
    }
    H5Sclose(space), H5Tclose(type), H5Aclose(attribute);
    return result;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, read, &numbers));
  return numbers;
}

std::string read_text(hid_t group, const std::string& path) {
  const Handle dataset = open_data_set(group, path);
  expect_text(dataset, "", {H5Dget_space(dataset), H5Sclose},
              {H5Dget_type(dataset), H5Tclose});
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_external_count(properties) != 0 || H5Pget_layout(properties) == H5D_VIRTUAL)
    refuse(dataset, "is in another file, which is not read");
  return text_from(dataset, [&](char** text) {
    return H5Dread(dataset, string_type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
  });
}

template <class T>
std::uint64_t checksum(std::span<const T> values) {
  return ::crc32_z(0, reinterpret_cast<const Bytef*>(values.data()), // NOLINT: any bytes
                   values.size_bytes());
}
template std::uint64_t checksum(std::span<const char>);
template std::uint64_t checksum(std::span<const double>);
template std::uint64_t checksum(std::span<const std::uint64_t>);

Handle create_rows(hid_t group, const char* name, hid_t type, hsize_t chunk_rows,
                   Packing packing) {
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  check(H5Pset_chunk(properties, 1, &chunk_rows));
  keep_no_times(properties);
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

void make_scale(hid_t dataset, const char* name) {
  check(H5DSset_scale(dataset, name));
}

void attach_scale(hid_t dataset, hid_t group, const char* scale) {
  const Handle opened(H5Dopen2(group, scale, H5P_DEFAULT), H5Dclose);
  check(H5DSattach_scale(dataset, opened, 0));
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
  if (const hsize_t all = length(dataset); first > all || rows > all - first)
    refuse(dataset, fmt::format("has {} rows, which is too few", all));
  if (std::is_integral_v<T>) {
    const Handle type(H5Dget_type(dataset), H5Tclose);
    if (H5Tget_class(type) != H5T_INTEGER)
      refuse(dataset, "is not a list of whole numbers");
  }
  std::vector<T> values(rows);
  if (rows == 0) return values;
  const Rows part(dataset, first, rows);
  expect(dataset,
         H5Dread(dataset, native(T{}), part.memory, part.file, H5P_DEFAULT, values.data()));
  return values;
}
template std::vector<double> read_rows(hid_t, hsize_t, hsize_t);
template std::vector<std::uint64_t> read_rows(hid_t, hsize_t, hsize_t);
template std::vector<std::uint8_t> read_rows(hid_t, hsize_t, hsize_t);

} // namespace ehdjet::hdf5
