#include "ehdjet/run_files/run_file.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "checkpoint_slots.hpp"
#include "file_driver.hpp"
#include "readable_file.hpp"

namespace ehdjet {

namespace fs = std::filesystem;
using hdf5::Handle;

namespace {

/// A checkpoint says under this prefix how many rows each column has.
constexpr const char* rows_part = "rows.";
constexpr const char* in_use = "is being written by another run";

// HDF5 needs a file in which it can go back.
NewFile regular_file(const fs::path& path, bool overwrite) {
  NewFile file(path, overwrite);
  if (file.is_stream())
    throw InputError(path.string() + " is not a regular file: choose another name with -o");
  if (overwrite && hdf5::ReplaceLock(path.c_str()).is_refused())
    throw InputError(path.string() + ' ' + in_use);
  return file;
}

Handle file_creation() {
  Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // The driver manages free space: HDF5 would reuse space that the last flush still needs.
  hdf5::check(H5Pset_file_space_strategy(properties, H5F_FSPACE_STRATEGY_NONE, false, 1));
  hdf5::keep_in_one_record(properties);
  hdf5::keep_no_times(properties);
  return properties;
}

Handle file_access() {
  return {hdf5::FileDriver::access_properties(), H5Pclose};
}

void write_statistics(hid_t file, const RunStatistics& s) {
  const Handle group = hdf5::create_group(file, "statistics");
  const auto write = [&](const char* name, const auto& value) {
    hdf5::write_attribute(group, name, value);
  };
  write("evaluations", s.evaluations), write("steps", s.steps);
  write("rejected", s.rejected), write("insertions", s.insertions);
  write("releases", s.releases), write("landings", s.landings);
  if (s.refinements) write("refinements", *s.refinements);
  if (s.two_rates) {
    write("macro_steps", s.two_rates->steps);
    write("inner_beads", s.two_rates->inner_beads);
    write("inner_evaluations", s.two_rates->inner_evaluations);
    write("full_sums", s.two_rates->full_sums);
  }
  if (s.method) {
    write("method", std::string(s.method->in_use));
    write("method_since", s.method->since), write("method_changes", s.method->changes);
  }
  write("coincident_pairs", s.coincident_pairs), write("wall_time", s.wall_time);
  write("shortest_step", s.shortest_step), write("longest_step", s.longest_step);
}

void write_ledger(hid_t file, const Ledger& ledger) {
  const Handle group = hdf5::create_group(file, "ledger");
  hdf5::write_attribute(group, "inserted_beads", ledger.inserted_beads);
  hdf5::write_attribute(group, "removed_beads", ledger.removed_beads);
  const std::pair<const char*, double> numbers[] = {
      {"inserted_mass", ledger.inserted_mass},
      {"removed_mass", ledger.removed_mass},
      {"inserted_charge", ledger.inserted_charge},
      {"removed_charge", ledger.removed_charge},
      {"inserted_volume", ledger.inserted_volume},
      {"removed_volume", ledger.removed_volume},
      {"release_speed", ledger.release_speed},
      {"impact_speed", ledger.impact_speed},
      {"collector_radius", ledger.collector_radius}};
  for (const auto& [name, value] : numbers) hdf5::write_attribute(group, name, value);
}

Handle group_in(hid_t file, const std::string& name) {
  return hdf5::has(file, name.c_str())
             ? Handle(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose)
             : hdf5::create_group(file, name.c_str());
}

// For statistics, ledger, status and message.
constexpr hsize_t room_for_the_end = 16384;

void write_status(hid_t file, const std::string& status, const std::string& message) {
  hdf5::write_attribute(file, "status", status);
  hdf5::write_attribute(file, "message", message);
}

} // namespace

/// The file of a stopped run, from which rows are copied, and which nobody else may replace.
struct RunFile::Source {
  explicit Source(const StoppedRun& run)
      : lock(run.file.c_str())
      , file(run.file)
      , checkpoint(run.checkpoint) {
    if (lock.is_refused()) file.reject(in_use);
  }

  /// Appends the rows that a column had at the checkpoint.
  void copy(const std::string& name, Column& column) {
    const auto found = checkpoint.find(rows_part + name);
    if (found == checkpoint.end() || found->second.size() != 1)
      file.reject("cannot be resumed: its checkpoint does not say how many rows /" + name
                  + " had. --continue goes on in another file");
    const double count = found->second[0];
    if (!(count >= 0)
        || count > static_cast<double>(file.guard([&] { return file.length(name); })))
      file.reject(
          fmt::format("is damaged: its checkpoint says that /{} has {} rows", name, count));
    constexpr std::size_t at_once = std::size_t{1} << 17U;
    const auto rows = static_cast<std::size_t>(count);
    for (std::size_t first = 0; first < rows; first += at_once)
      column.append(file.guard(
          [&] { return file.rows<double>(name, first, std::min(at_once, rows - first)); }));
  }

  hdf5::ReplaceLock lock;
  ReadableFile file;
  Checkpoint checkpoint;
};

void RunFile::guard(const std::function<void()>& action) {
  const auto check = [&] {
    failed_ |= broken();
    if (broken())
      throw RunError(fmt::format("cannot write {}: {}. It is readable up to the last flush",
                                 path_.string(),
                                 std::strerror(hdf5::FileDriver::of(*file_).error())));
  };
  check();
  try {
    action();
  } catch (const hdf5::Failure& failure) {
    check();
    // The disk has not failed: the message of HDF5 is reported.
    failed_ = true;
    if (*file_ >= 0) hdf5::FileDriver::of(*file_).abandon(EIO);
    throw RunError(fmt::format("cannot write {}: {}", path_.string(), failure.what()));
  }
  check();
}

RunFile::RunFile(const fs::path& path, bool overwrite, const Provenance& provenance,
                 double flush_interval)
    : flush_interval_(flush_interval)
    , unnamed_(std::make_unique<NewFile>(regular_file(path, overwrite)))
    , file_(std::make_unique<Handle>()) {
  create(provenance);
  publish();
}

RunFile::RunFile(const StoppedRun& run, const Provenance& provenance, double flush_interval)
    : flush_interval_(flush_interval)
    , unnamed_(std::make_unique<NewFile>(regular_file(run.file, true)))
    , file_(std::make_unique<Handle>())
    , source_(std::make_unique<Source>(run)) {
  create(provenance);
}

void RunFile::create(const Provenance& provenance) {
  hdf5::silence_errors();
  path_ = unnamed_->target(); // for messages
  const fs::path& temporary = unnamed_->create();
  guard([&] {
    *file_ = {H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, file_creation(), file_access()),
              H5Fclose};
    hdf5::FileDriver::of(*file_).keep_room(room_for_the_end);
    hdf5::write_attribute(*file_, "format", std::string("ehdjet run"));
    hdf5::write_attribute(*file_, "format_version", std::uint64_t{1});
    write_status(*file_, "running", "");
    hdf5::write_attribute(*file_, "scene_file", provenance.scene_file);
    for (const auto& [name, value] : provenance.environment)
      hdf5::write_attribute(*file_, name.c_str(), value);
    const Handle scene = hdf5::create_group(*file_, "scene");
    hdf5::write_text(scene, "given", provenance.scene_given);
    hdf5::write_text(scene, "resolved", provenance.scene_resolved);
  });
  flush();
}

void RunFile::publish() {
  unnamed_->publish();
  path_ = unnamed_->target();
  unnamed_.reset();
}

void RunFile::take_place() {
  EHDJET_EXPECTS(source_ && unnamed_);
  keep(source_->checkpoint);
  publish();
  source_.reset();
}

RunFile::~RunFile() {
  if (*file_ < 0) return;
  try {
    if (!broken()) flush();
  } catch (const Error&) { // a destructor cannot report it; the last flush stays readable
  }
  close();
}

Column& RunFile::add_column(const std::string& group, const ColumnInfo& info,
                            std::size_t chunk_rows) {
  guard([&] { columns_.emplace_back(group_in(*file_, group), info, chunk_rows); });
  names_.push_back(group + '/' + info.name);
  if (source_) guard([&] { source_->copy(names_.back(), columns_.back()); });
  return columns_.back();
}

void RunFile::describe(const std::string& group, const char* attribute,
                       const std::string& text) {
  guard([&] { hdf5::write_attribute(group_in(*file_, group), attribute, text); });
}

void RunFile::write(const std::function<void()>& append) {
  EHDJET_EXPECTS(*file_ >= 0); // not finished yet
  guard(append);
  ++records_;
  if (std::chrono::steady_clock::now() - flushed_ >= flush_interval_) flush();
}

void RunFile::flush() {
  guard([&] {
    for (Column& column : columns_) column.flush();
    hdf5::check(H5Fflush(*file_, H5F_SCOPE_LOCAL));
    hdf5::FileDriver::of(*file_).commit();
  });
  if (!failed_) flushed_records_ = records_; // later flushes only add the end of the run
  flushed_ = std::chrono::steady_clock::now();
  follow();
  if (removed_)
    throw RunError(path_.string() + " has been removed or replaced during the run");
}

// Another program may have renamed or removed the file.
void RunFile::follow() {
  const fs::path now = hdf5::FileDriver::of(*file_).place(path_);
  removed_ = now.empty();
  if (!removed_) path_ = now;
}

// The slot is committed before it is made current: the current slot is always complete.
void RunFile::keep(const Checkpoint& checkpoint) {
  std::uint64_t slot = 0;
  Checkpoint with_rows = checkpoint;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    with_rows[rows_part + names_[i]] = {static_cast<double>(columns_[i].rows())};
  guard([&] { slot = hdf5::fill_free_slot(*file_, with_rows); });
  flush();
  guard([&] { hdf5::make_current(*file_, slot); });
  flush();
  guard([&] { hdf5::FileDriver::of(*file_).sync(); });
}

void RunFile::finish(const std::string& status, const std::string& message,
                     const RunStatistics& statistics, const Ledger& ledger,
                     const std::map<std::string, std::string>& notes) {
  EHDJET_EXPECTS(*file_ >= 0); // not finished yet
  const auto rest = [&] {
    for (const auto& [name, value] : notes)
      hdf5::write_attribute(*file_, name.c_str(), value);
    write_statistics(*file_, statistics);
    write_ledger(*file_, ledger);
  };
  if (removed_) return close();
  std::optional<RunError> failure;
  if (!broken()) {
    hdf5::FileDriver::of(*file_).keep_room(0);
    try {
      return write_end(status, message, rest);
    } catch (const RunError& error) {
      failure = error;
    }
  }
  follow();
  close();
  // The file goes back to the last flush, behind which there is room. If another program took it, what there is
  // may still do for the status.
  const std::string outcome = failure ? "failed" : status,
                    reason = failure ? failure->what() : message;
  for (const std::function<void()>& more :
       {std::function<void()>(rest), std::function<void()>()}) {
    if (removed_) break;
    try {
      guard([&] {
        *file_ = {H5Fopen(path_.c_str(), H5F_ACC_RDWR, file_access()), H5Fclose};
      });
      write_end(outcome, reason, more);
      break;
    } catch (const RunError&) { // the first failure is reported
      close();
    }
  }
  if (failure) throw RunError(*failure);
}

void RunFile::write_end(const std::string& status, const std::string& message,
                        const std::function<void()>& rest) {
  guard([&] {
    write_status(*file_, status, message);
    if (rest) rest();
  });
  flush();
  guard([&] { hdf5::FileDriver::of(*file_).sync(); });
  close();
}

std::string RunFile::contents() const {
  if (removed_) return "nothing is left of it";
  if (!failed_) return fmt::format("everything up to then is in {}", path_.string());
  return fmt::format("{} has {} of {} rows, frames and other records", path_.string(),
                     flushed_records_, records_);
}

void RunFile::close() {
  columns_.clear();
  file_->reset();
}

bool RunFile::broken() const {
  return *file_ >= 0 && hdf5::FileDriver::of(*file_).error() != 0;
}

} // namespace ehdjet
