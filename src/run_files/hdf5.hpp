#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ehdjet::hdf5 {

/// A call of the HDF5 library failed. The classes that own a file turn it into an Error.
class Failure : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One HDF5 identifier with one owner.
class Handle {
public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// `id`: the result of an H5Xopen or H5Xcreate. errors : Failure if that call failed
  Handle(hid_t id, Close close);
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID))
      , close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_), std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }
  void reset();

private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

[[noreturn]] void fail(); ///< throws a Failure with the message of the library
template <class Result>
Result check(Result result) {
  if (result < 0) fail();
  return result;
}

/// Stops the library from printing its error stack. ehdjet reports each error itself.
void silence_errors();

Handle string_type();
/// Makes a file, group or data set keep no times, so that the same run gives the same bytes.
void keep_no_times(hid_t creation_properties);
/// Makes a file or group keep its links and attributes in one record, without a heap and an index.
void keep_in_one_record(hid_t creation_properties);
Handle create_group(hid_t parent, const char* name);
bool has(hid_t parent, const char* name);

void write_attribute(hid_t object, const char* name, const std::string& value);
void write_attribute(hid_t object, const char* name, double value);
void write_attribute(hid_t object, const char* name, std::uint64_t value);
/// Creates a scalar data set.
void write_text(hid_t group, const char* name, const std::string& text);

bool has_attribute(hid_t object, const char* name);

/// What is read may come from anywhere. These functions look at the kind, the size and the place of an object before
/// they take memory for it; objects that lie in another file or behind a link to another place are refused.
/// errors : Failure that names the object
[[noreturn]] void refuse(hid_t object, const std::string& reason);
/// `path`: names below `parent`, separated by slashes.
Handle open_group(hid_t parent, const std::string& path);
/// A one-dimensional list of numbers.
Handle open_rows(hid_t parent, const std::string& path);
std::string read_text_attribute(hid_t object, const char* name);
std::uint64_t read_count_attribute(hid_t object, const char* name);
/// All attributes of an object that are one number, by their names.
std::map<std::string, double> read_number_attributes(hid_t object);
std::string read_text(hid_t group, const std::string& path);

/// The HDF5 type of a number in memory.
inline hid_t native(double) {
  return H5T_NATIVE_DOUBLE;
}
inline hid_t native(std::uint64_t) {
  return H5T_NATIVE_UINT64;
}
inline hid_t native(std::uint8_t) {
  return H5T_NATIVE_UINT8;
}

/// CRC-32, as in zlib, of the bytes of the values.
template <class T>
std::uint64_t checksum(std::span<const T> values);

/// Creates an empty one-dimensional data set that can grow.
enum class Packing { none, deflate };
Handle create_rows(hid_t group, const char* name, hid_t type, hsize_t chunk_rows,
                   Packing packing);
hsize_t length(hid_t dataset);
/// Makes a data set an HDF5 dimension scale, and has another one refer to it.
void make_scale(hid_t dataset, const char* name);
void attach_scale(hid_t dataset, hid_t group, const char* scale);
/// A full chunk as a data set with Packing::deflate stores it. Unlike the library, which does the same in
/// `write_rows`, it may be used by several threads at once.
class PackedChunk {
public:
  explicit PackedChunk(std::size_t bytes);
  /// `rows` of that many bytes, `row_size` bytes each. Returns whether it succeeded.
  bool pack(const unsigned char* rows, std::size_t row_size);
  /// Makes it the rows from `first` on, which the data set must have.
  void write(hid_t dataset, hsize_t first) const;

private:
  std::vector<unsigned char> shuffled_, packed_;
  std::size_t size_ = 0;
};
/// Writes the rows first .. first + rows - 1, which the data set must have.
void write_rows(hid_t dataset, hid_t type, hsize_t first, hsize_t rows, const void* values);
/// Reads such rows. errors : Failure if the data set does not have them
template <class T>
std::vector<T> read_rows(hid_t dataset, hsize_t first, hsize_t rows);

} // namespace ehdjet::hdf5
