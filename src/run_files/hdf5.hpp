#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ehdjet::hdf5 {

/// A call of the HDF5 library failed; the classes that own a file say so in their own words.
class Failure : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One HDF5 identifier with one owner.
class Handle {
public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// Takes what an H5Xopen or H5Xcreate returned. errors : Failure if that failed
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

[[noreturn]] void fail(); ///< Failure in the library's own words
template <class Result>
Result check(Result result) {
  if (result < 0) fail();
  return result;
}

/// Keeps the library from printing its error stack; an error is reported once, by us.
void silence_errors();

Handle string_type();
Handle create_group(hid_t parent, const char* name);
bool has(hid_t parent, const char* name);

void write_attribute(hid_t object, const char* name, const std::string& value);
void write_attribute(hid_t object, const char* name, double value);
void write_attribute(hid_t object, const char* name, std::uint64_t value);
void write_text(hid_t group, const char* name,
                const std::string& text); ///< a scalar data set

bool has_attribute(hid_t object, const char* name);
std::string read_text_attribute(hid_t object, const char* name);
std::uint64_t read_count_attribute(hid_t object, const char* name);
std::string read_text(hid_t group, const char* name);

hid_t native(double);
hid_t native(std::uint64_t);
hid_t native(std::uint8_t);

hsize_t length(hid_t dataset);
/// Rows first .. first + rows - 1 of a one-dimensional data set.
template <class T>
std::vector<T> read_rows(hid_t dataset, hsize_t first, hsize_t rows);

} // namespace ehdjet::hdf5
