#include "ehdjet/run_files/run_file.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>

#include "checkpoint_slots.hpp"
#include "file_driver.hpp"

namespace ehdjet {

namespace fs = std::filesystem;
using hdf5::Handle;

namespace {

// The file is created under a temporary name and gets its final name as soon as it can be opened.
// If something fails before that, an older file of the final name is not changed.
class TemporaryFile {
public:
  explicit TemporaryFile(const fs::path& target)
      : target_(target)
      , path_(target.parent_path()
              / fmt::format(".{}.{}", target.filename().string(),
                            static_cast<long>(::getpid()))) {
    const int file =
        ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666); // NOLINT
    if (file < 0)
      throw InputError(fmt::format("cannot create {}: {}. Choose another name with -o",
                                   target.string(), std::strerror(errno)));
    ::close(file);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    if (!renamed_) fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }
  void rename() {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error)
      throw InputError(
          fmt::format("cannot create {}: {}", target_.string(), error.message()));
    renamed_ = true;
  }

private:
  fs::path target_, path_;
  bool renamed_ = false;
};

// The path of the file without links. Throws if the file may not be created there.
fs::path checked(const fs::path& path, bool overwrite) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    const std::string name = path.string();
    if (!fs::is_regular_file(path))
      throw InputError(name + " is not a regular file: choose another name with -o");
    if (!overwrite)
      throw InputError(
          name + " exists: choose another name with -o or overwrite it with --force");
    if (::access(path.c_str(), W_OK) != 0)
      throw InputError(fmt::format("cannot overwrite {}: {}", name, std::strerror(errno)));
    return fs::canonical(path);
  }
  fs::path absolute = fs::absolute(path);
  if (!fs::is_directory(absolute.parent_path(), ignored))
    throw InputError(fmt::format("cannot create {}: there is no folder {}", path.string(),
                                 absolute.parent_path().string()));
  return absolute;
}

Handle file_creation() {
  Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // The driver manages free space: HDF5 would reuse space that the last flush still needs.
  hdf5::check(H5Pset_file_space_strategy(properties, H5F_FSPACE_STRATEGY_NONE, false, 1));
  hdf5::keep_in_one_record(properties);
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

void write_status(hid_t file, const std::string& status, const std::string& message) {
  hdf5::write_attribute(file, "status", status);
  hdf5::write_attribute(file, "message", message);
}

} // namespace

void RunFile::guard(const std::function<void()>& action) {
  const auto check = [&] {
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
    if (*file_ >= 0) hdf5::FileDriver::of(*file_).abandon(EIO);
    throw RunError(fmt::format("cannot write {}: {}", path_.string(), failure.what()));
  }
  check();
}

RunFile::RunFile(const fs::path& path, bool overwrite, const Provenance& provenance,
                 double flush_interval)
    : path_(checked(path, overwrite))
    , flush_interval_(flush_interval)
    , file_(std::make_unique<Handle>()) {
  hdf5::silence_errors();
  TemporaryFile temporary(path_);
  guard([&] {
    *file_ = {
        H5Fcreate(temporary.path().c_str(), H5F_ACC_TRUNC, file_creation(), file_access()),
        H5Fclose};
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
  temporary.rename();
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
  return columns_.back();
}

void RunFile::describe(const std::string& group, const char* attribute,
                       const std::string& text) {
  guard([&] { hdf5::write_attribute(group_in(*file_, group), attribute, text); });
}

void RunFile::write(const std::function<void()>& append) {
  EHDJET_EXPECTS(*file_ >= 0); // not finished yet
  guard(append);
  if (std::chrono::steady_clock::now() - flushed_ >= flush_interval_) flush();
}

void RunFile::flush() {
  guard([&] {
    for (Column& column : columns_) column.flush();
    hdf5::check(H5Fflush(*file_, H5F_SCOPE_LOCAL));
    hdf5::FileDriver::of(*file_).commit();
  });
  flushed_ = std::chrono::steady_clock::now();
}

// The slot is committed before it is made current: the current slot is always complete.
void RunFile::keep(const Checkpoint& checkpoint) {
  std::uint64_t slot = 0;
  guard([&] { slot = hdf5::fill_free_slot(*file_, checkpoint); });
  flush();
  guard([&] { hdf5::make_current(*file_, slot); });
  flush();
}

void RunFile::finish(const std::string& status, const std::string& message,
                     const RunStatistics& statistics, const Ledger& ledger,
                     const std::map<std::string, std::string>& notes) {
  EHDJET_EXPECTS(*file_ >= 0); // not finished yet
  const auto write_end = [&] {
    write_status(*file_, status, message);
    for (const auto& [name, value] : notes)
      hdf5::write_attribute(*file_, name.c_str(), value);
    write_statistics(*file_, statistics);
    write_ledger(*file_, ledger);
  };
  if (!broken()) {
    guard(write_end);
    flush();
    close();
    return;
  }
  // The file goes back to the last flush, which fits on the disk, and gets the status and message.
  close();
  try {
    guard([&] {
      *file_ = {H5Fopen(path_.c_str(), H5F_ACC_RDWR, file_access()), H5Fclose};
    });
    guard(write_end);
    flush();
  } catch (const RunError&) { // the first failure has already been reported
  }
  close();
}

void RunFile::close() {
  columns_.clear();
  file_->reset();
}

bool RunFile::broken() const {
  return *file_ >= 0 && hdf5::FileDriver::of(*file_).error() != 0;
}

} // namespace ehdjet
