#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/run_files/column.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace ehdjet {
namespace hdf5 {
class Handle;
}

/// What a run file says about where it came from. Written as root attributes.
struct Provenance {
  std::string scene_file, scene_given, scene_resolved;
  std::map<std::string, std::string>
      environment; ///< version, commit, compiler, simd, threads, ...
};

/// One run, one HDF5 file, written as the run goes. Layout: src/run_files/README.md.
///
/// Readable without this project (h5py, h5dump) and, up to the last flush, after the process
/// was killed. Only the parts that are asked for exist in the file. Who writes to it shares its
/// ownership: the file stays open until the last of them is gone, or until `finish`.
/// errors : InputError if the file exists and `overwrite` is false, or cannot be created;
///          RunError if writing fails (disk full)
class RunFile {
public:
  /// `flush_interval` in [s].
  RunFile(const std::filesystem::path& path, bool overwrite, const Provenance& provenance,
          double flush_interval);
  ~RunFile(); ///< closes; a file without `finish` keeps the status "running"
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  /// A new data set, empty, in a group at the root that is made if need be. It lives until the
  /// file is closed, and is in the file after the next flush.
  Column& add_column(const std::string& group, const ColumnInfo& info,
                     std::size_t chunk_rows);
  /// An attribute of such a group.
  void describe(const std::string& group, const char* attribute, const std::string& text);
  /// Runs `append`, which appends one whole row, frame or part, and flushes if it is time.
  void write(const std::function<void()>& append);
  /// Keeps a checkpoint instead of the last one, which stays until the new one is complete, and
  /// flushes. All of a run have the same names.
  void keep(const Checkpoint& checkpoint);
  /// Makes everything written so far readable by others.
  void flush();
  /// Last words: status "complete", "interrupted" or "failed", a message, the run's cost, what
  /// entered and left the jet, and further root attributes. Closes the file.
  void finish(const std::string& status, const std::string& message,
              const RunStatistics& statistics, const Ledger& ledger,
              const std::map<std::string, std::string>& notes = {});

private:
  template <class Action>
  void guard(const Action& action);
  [[nodiscard]] bool broken() const;
  [[noreturn]] void abandon(const std::exception& failure);
  [[noreturn]] void throw_error() const;
  void create(const Provenance& provenance);
  void close();

  std::filesystem::path path_;
  std::chrono::duration<double> flush_interval_;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
  std::unique_ptr<hdf5::Handle> file_; // HDF5 stays inside src/run_files
  std::deque<Column> columns_;         // observers refer to them
};

} // namespace ehdjet
