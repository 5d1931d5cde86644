#include "ehdjet/run_files/run_file.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>

#include "checkpoint_slots.hpp"
#include "data_set.hpp"
#include "file_driver.hpp"

namespace ehdjet {

namespace fs = std::filesystem;
using hdf5::Handle;

namespace {

// The file grows beside its final name and takes that name once it is complete enough to be
// opened: whatever goes wrong before leaves an older file of that name as it was.
class TemporaryFile {
public:
  explicit TemporaryFile(const fs::path& target)
      : target_(target)
      , path_(target.parent_path()
              / fmt::format(".{}.{}", target.filename().string(),
                            static_cast<long>(::getpid()))) {
    const int file =
        ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666); // NOLINT
    if (file < 0) {
      throw InputError(fmt::format("cannot create {}: {}. Choose another name with -o",
                                   target.string(), std::strerror(errno)));
    }
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

// Where the file will really be, if it may be there.
fs::path checked(const fs::path& path, bool overwrite) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    const std::string name = path.string();
    if (!fs::is_regular_file(path))
      throw InputError(name + " is no regular file: choose another name with -o");
    if (!overwrite) {
      throw InputError(
          name + " exists: choose another name with -o or overwrite it with --force");
    }
    if (::access(path.c_str(), W_OK) != 0) {
      throw InputError(fmt::format("cannot overwrite {}: {}", name, std::strerror(errno)));
    }
    return fs::canonical(path); // through links
  }
  fs::path absolute = fs::absolute(path);
  if (!fs::is_directory(absolute.parent_path(), ignored)) {
    throw InputError(fmt::format("cannot create {}: there is no folder {}", path.string(),
                                 absolute.parent_path().string()));
  }
  return absolute;
}

Handle file_creation() {
  Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // HDF5 would reuse freed space at once, while the last flush still needs it; the driver does not.
  hdf5::check(H5Pset_file_space_strategy(properties, H5F_FSPACE_STRATEGY_NONE, false, 1));
  hdf5::check(
      H5Pset_link_phase_change(properties, 64, 32)); // one record, not a heap and an index
  hdf5::check(H5Pset_attr_phase_change(properties, 64, 32));
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
  if (s.method) {
    write("method", std::string(s.method->in_use));
    write("method_since", s.method->since), write("method_changes", s.method->changes);
  }
  write("coincident_pairs", s.coincident_pairs), write("wall_time", s.wall_time);
  write("shortest_step", s.shortest_step), write("longest_step", s.longest_step);
}

void write_ledger(hid_t file, const Ledger& ledger) {
  const Handle group = hdf5::create_group(file, "ledger");
  const auto write = [&](const char* name, double value) {
    hdf5::write_attribute(group, name, value);
  };
  hdf5::write_attribute(group, "inserted_beads", ledger.inserted_beads);
  hdf5::write_attribute(group, "removed_beads", ledger.removed_beads);
  write("inserted_mass", ledger.inserted_mass);
  write("removed_mass", ledger.removed_mass);
  write("inserted_charge", ledger.inserted_charge);
  write("removed_charge", ledger.removed_charge);
  write("inserted_volume", ledger.inserted_volume);
  write("removed_volume", ledger.removed_volume);
  write("release_speed", ledger.release_speed);
  write("impact_speed", ledger.impact_speed);
  write("collector_radius", ledger.collector_radius);
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

template <class Action>
void RunFile::guard(const Action& action) {
  if (broken()) throw_error();
  try {
    action();
  } catch (const hdf5::Failure& failure) {
    abandon(failure);
  }
  if (broken()) throw_error();
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
    create(provenance);
  });
  flush();
  temporary.rename();
}

RunFile::~RunFile() {
  if (*file_ < 0) return;
  try {
    if (!broken()) flush();
  } catch (const Error&) { // nobody left to tell; what was flushed before is safe
  }
  close();
}

void RunFile::create(const Provenance& provenance) {
  hdf5::write_attribute(*file_, "format", std::string("ehdjet run"));
  hdf5::write_attribute(*file_, "format_version", std::uint64_t{1});
  write_status(*file_, "running", "");
  hdf5::write_attribute(*file_, "scene_file", provenance.scene_file);
  for (const auto& [name, value] : provenance.environment) {
    hdf5::write_attribute(*file_, name.c_str(), value);
  }
  const Handle scene = hdf5::create_group(*file_, "scene");
  hdf5::write_text(scene, "given", provenance.scene_given);
  hdf5::write_text(scene, "resolved", provenance.scene_resolved);
}

Column& RunFile::add_column(const std::string& group, const ColumnInfo& info,
                            std::size_t chunk_rows) {
  guard([&] {
    columns_.emplace_back(
        Column::DataSet::create(group_in(*file_, group), info, chunk_rows), info.type,
        chunk_rows);
  });
  return columns_.back();
}

void RunFile::describe(const std::string& group, const char* attribute,
                       const std::string& text) {
  guard([&] { hdf5::write_attribute(group_in(*file_, group), attribute, text); });
}

void RunFile::write(const std::function<void()>& append) {
  EHDJET_EXPECTS(*file_ >= 0); // not finished
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

// Two commits: at no time does the file name a slot that is not complete.
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
  EHDJET_EXPECTS(*file_ >= 0); // once
  const auto last_words = [&] {
    write_status(*file_, status, message);
    for (const auto& [name, value] : notes)
      hdf5::write_attribute(*file_, name.c_str(), value);
    write_statistics(*file_, statistics);
    write_ledger(*file_, ledger);
  };
  if (!broken()) {
    guard(last_words);
    flush();
    close();
    return;
  }
  // Back to the last flush, which fits on the disk; it only has to be told why it is the last. The
  // caller knows already that the file could not be written: failing again is no news.
  close();
  try {
    guard([&] {
      *file_ = {H5Fopen(path_.c_str(), H5F_ACC_RDWR, file_access()), H5Fclose};
    });
    guard(last_words);
    flush();
  } catch (const RunError&) {
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

void RunFile::abandon(const std::exception& failure) {
  if (broken()) throw_error();
  if (*file_ >= 0)
    hdf5::FileDriver::of(*file_).abandon(EIO); // not the disk: say what HDF5 says
  throw RunError(fmt::format("cannot write {}: {}", path_.string(), failure.what()));
}

void RunFile::throw_error() const {
  throw RunError(fmt::format("cannot write {}: {}. It is readable up to the last flush",
                             path_.string(),
                             std::strerror(hdf5::FileDriver::of(*file_).error())));
}

} // namespace ehdjet
