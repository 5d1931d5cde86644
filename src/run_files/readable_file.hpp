#pragma once

#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/run_table.hpp"

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hdf5.hpp"

namespace ehdjet {

/// An HDF5 file that is open for reading, its data sets, and what to say if something is wrong.
class ReadableFile {
public:
  explicit ReadableFile(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] hid_t file() const { return file_; }
  /// errors : InputError
  [[noreturn]] void reject(const std::string& reason) const;
  /// Does `read`; what HDF5 complains of becomes an InputError.
  template <class Read>
  auto guard(const Read& read) const {
    try {
      return read();
    } catch (const hdf5::Failure& failure) {
      reject(
          fmt::format("cannot be read, it is damaged or truncated ({})", failure.what()));
    }
  }
  [[nodiscard]] bool has(const std::string& name) const;
  /// Refuses a file without a part, and says which key of a scene asks for it.
  void require(const std::string& part) const;

  template <class T>
  std::vector<T> rows(const std::string& name, std::uint64_t first, std::uint64_t count) {
    return hdf5::read_rows<T>(data_set(name), first, count);
  }
  std::uint64_t length(const std::string& name) { return hdf5::length(data_set(name)); }
  std::string unit(const std::string& name);
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const;
  /// Rows that all data sets of a group have: a run killed within a commit may have left some of
  /// them longer by what the next flush was about to add.
  std::uint64_t common_length(const std::string& group);
  /// These rows of the columns of a group.
  std::vector<RunTable::Column> columns(const std::string& group,
                                        const std::vector<std::string>& names,
                                        std::uint64_t first, std::uint64_t count);

  /// Rows in /beads where whole frames begin, and where the last one ends: one more than frames.
  const std::vector<std::uint64_t>& frame_offsets();

private:
  hid_t data_set(const std::string& name);

  std::filesystem::path path_;
  hdf5::Handle file_;
  std::map<std::string, hdf5::Handle>
      data_sets_; // kept open: each holds its last chunks unpacked
  std::map<std::string, std::string> units_;
  std::optional<std::vector<std::uint64_t>> frame_offsets_;
};

} // namespace ehdjet
