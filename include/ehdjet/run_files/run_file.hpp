#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

class NewFile;
namespace hdf5 {
class Handle; // HDF5 is used only inside src/run_files
}

/// How the values of a column are stored: as doubles, 64-bit counts or flags of one byte.
enum class ColumnType { real, count, flag };

/// Name and attributes of a data set.
struct ColumnInfo {
  std::string name, unit, description;
  ColumnType type = ColumnType::real;
  /// The data set of the same group that has a value for each of its rows, if there is one: the HDF5
  /// dimension scale, from which other programs know what belongs together. Its own name: it is one.
  std::string scale = "time";
};

/// A one-dimensional data set of a run file, to which rows are appended.
///
/// Rows are collected in memory and written one chunk at a time. `flush` also writes the incomplete
/// chunk, which is written again when it has grown. Many chunks at once are packed by all threads. Only
/// then is memory allocated outside the constructor.
/// Rows may be appended only within `RunFile::write`, which handles failures.
class Column {
public:
  /// Creates the data set in a group.
  Column(const hdf5::Handle& group, const ColumnInfo& info, std::size_t chunk_rows);
  ~Column();

  /// Counts are exact up to 2^53.
  void append(double value);
  void append(std::span<const double> values);
  void flush();
  /// Rows so far.
  [[nodiscard]] std::size_t rows() const { return first_ + rows_; }

private:
  void append_bytes(const void* values, std::size_t rows);
  void append_chunks(const unsigned char* values, std::size_t chunks);
  void write_chunk();

  std::unique_ptr<hdf5::Handle> dataset_;
  ColumnType type_;
  std::size_t row_size_, chunk_rows_;
  std::size_t first_ = 0;   ///< row of the data set where the chunk in memory begins
  std::size_t rows_ = 0;    ///< rows in that chunk
  std::size_t written_ = 0; ///< of these rows, how many have been written
  std::vector<unsigned char> chunk_;
};

/// The origin of a run file.
struct Provenance {
  std::string scene_file, scene_given, scene_resolved;
  /// Root attributes by name: version, commit, compiler, simd, threads, ...
  std::map<std::string, std::string> environment;
};

/// The file of a run that was stopped, and the last checkpoint in it.
struct StoppedRun {
  std::filesystem::path file;
  Checkpoint checkpoint;
};

/// The HDF5 file of one run, which is written during the run. Layout: src/run_files/README.md.
///
/// Other programs (h5py, h5dump) can read the file. If the process is killed, the file is readable
/// up to the last flush. It contains only the parts that the scene asks for. The observers that
/// write to it share its ownership: the file stays open until the last of them is destroyed, or
/// until `finish`.
/// errors : InputError if the file exists and `overwrite` is false, or cannot be created;
///          RunError if writing fails (disk full), or if the file has been removed or replaced
class RunFile {
public:
  /// `flush_interval` in [s].
  RunFile(const std::filesystem::path& path, bool overwrite, const Provenance& provenance,
          double flush_interval);
  /// Goes on with the file of a stopped run: columns that are added begin with the rows that they had at
  /// its checkpoint. The file gets its name, and replaces the old one, with `take_place`.
  /// errors : as above; InputError if the checkpoint does not say how many rows there were
  RunFile(const StoppedRun& run, const Provenance& provenance, double flush_interval);
  ~RunFile(); ///< closes the file; without `finish` its status remains "running"
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  /// Adds an empty data set to a group below the root, which is created if necessary. The reference
  /// is valid until the file is closed. The data set is in the file after the next flush.
  Column& add_column(const std::string& group, const ColumnInfo& info,
                     std::size_t chunk_rows);
  /// After all columns have been added to the file of a stopped run: keeps its checkpoint and replaces
  /// the old file.
  void take_place();
  /// Writes an attribute of such a group.
  void describe(const std::string& group, const char* attribute, const std::string& text);
  /// Calls `append`, which appends one whole row, frame or part. Flushes if `flush_interval` has
  /// passed since the last flush.
  void write(const std::function<void()>& append);
  /// Replaces the last checkpoint, which is kept until the new one is complete, and flushes. It survives a
  /// crash of the machine. All checkpoints of a run must have the same names.
  void keep(const Checkpoint& checkpoint);
  /// Makes everything that has been written readable by other programs.
  void flush();
  /// Writes the status ("complete", "interrupted" or "failed"), a message, the statistics, the
  /// ledger and further root attributes, which then survive a crash of the machine. Closes the file. If the
  /// disk is full, the file goes back to its last flush, and its status becomes "failed".
  void finish(const std::string& status, const std::string& message,
              const RunStatistics& statistics, const Ledger& ledger,
              const std::map<std::string, std::string>& notes = {});
  /// Where the file is: under another name if it has been renamed before `finish`.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// For messages: how much of the run the file has after `finish`.
  [[nodiscard]] std::string contents() const;

private:
  struct Source;

  void create(const Provenance& provenance);
  void publish();
  void write_end(const std::string& status, const std::string& message,
                 const std::function<void()>& rest);
  void follow();
  void guard(const std::function<void()>& action);
  [[nodiscard]] bool broken() const;
  void close();

  std::filesystem::path path_;
  bool removed_ = false, failed_ = false;
  std::uint64_t records_ = 0, flushed_records_ = 0;
  std::chrono::duration<double> flush_interval_;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
  std::unique_ptr<NewFile> unnamed_; // until the file has its name
  std::unique_ptr<hdf5::Handle> file_;
  std::unique_ptr<Source> source_; // what the file goes on with, until it takes its place
  std::deque<Column> columns_;     // a deque, because observers refer to the columns
  std::vector<std::string> names_; // of the columns, with their groups
};

} // namespace ehdjet
