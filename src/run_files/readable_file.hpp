#pragma once

#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hdf5.hpp"

namespace ehdjet {

/// An HDF5 file that is open for reading. Errors are reported with its path.
class ReadableFile {
public:
  explicit ReadableFile(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] hid_t file() const { return file_; }
  /// errors : InputError
  [[noreturn]] void reject(const std::string& reason) const;
  /// Calls `read` and turns an HDF5 failure into an InputError.
  template <class Read>
  auto guard(const Read& read) const {
    try {
      return read();
    } catch (const hdf5::Failure& failure) {
      reject(
          fmt::format("cannot be read: it is damaged or truncated ({})", failure.what()));
    }
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return hdf5::has(file_, name.c_str());
  }
  /// errors : InputError, with the key of the scene that asks for the part, if it is missing
  void require(const std::string& part) const;

  template <class T>
  std::vector<T> rows(const std::string& name, std::uint64_t first, std::uint64_t count) {
    return hdf5::read_rows<T>(data_set(name).handle, first, count);
  }
  std::uint64_t length(const std::string& name) {
    return hdf5::length(data_set(name).handle);
  }
  /// errors : InputError that names the data set if a value is not a number or infinite
  void expect_finite(const std::string& name, const std::vector<double>& values) const;
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const;
  /// Number of rows that all data sets of a group have. If a run was killed during a commit, some
  /// data sets may have more rows.
  std::uint64_t common_length(const std::string& group);
  /// `count` rows of the named columns of a group.
  std::vector<RunTable::Column> columns(const std::string& group,
                                        const std::vector<std::string>& names,
                                        std::uint64_t first, std::uint64_t count);

  /// The first row in /beads of each whole frame, and the end of the last frame (frames + 1).
  const std::vector<std::uint64_t>& frame_offsets();

private:
  struct DataSet {
    hdf5::Handle handle;
    std::string unit;
  };
  const DataSet& data_set(const std::string& name);

  std::filesystem::path path_;
  hdf5::Handle file_;
  std::map<std::string, DataSet> data_sets_; // kept open: HDF5 caches their last chunks
  std::optional<std::vector<std::uint64_t>> frame_offsets_;
};

} // namespace ehdjet
