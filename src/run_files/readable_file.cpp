#include "readable_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fcntl.h>
#include <limits>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace ehdjet {
namespace {

/// The parts of a run file, their names in messages, and the keys of a scene that ask for them.
struct Part {
  const char *group, *meaning, *remedy;
};
constexpr std::array<Part, 6> parts{
    {{"observables", "observables", "output.observables"},
     {"frames", "frames", "output.frames"},
     {"deposit", "deposit", "output.deposit = true"},
     {"refinements", "record of refinements", "output.refinements"},
     {"budget", "budget of energy and momentum", "output.budget"},
     {"resolving_power", "resolving power", "output.resolving_power"}}};

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

/// Whether another program has locked the file.
bool is_locked(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); // NOLINT
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

/// HDF5 locks what it reads. Where the file system has no locks, the file is read all the same.
hdf5::Handle open_for_reading(const std::filesystem::path& path) {
  try {
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  } catch (const hdf5::Failure&) {
    if (is_locked(path)) throw;
  }
  const hdf5::Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  hdf5::check(H5Pset_file_locking(access, false, true));
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
}

// In names and units, which exports repeat.
bool is_harmless(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')
         || std::string_view(" _-+*.^/()%").find(c) != std::string_view::npos;
}

} // namespace

ReadableFile::ReadableFile(const std::filesystem::path& path)
    : path_(path) {
  hdf5::silence_errors();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) reject("does not exist");
  if (std::filesystem::is_directory(path, ignored)) reject("is a folder, not a run file");
  if (!std::filesystem::is_regular_file(path, ignored)) reject("is not a regular file");
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 < 0) reject("cannot be opened");
  if (is_hdf5 == 0) reject("is not an HDF5 file");
  try {
    file_ = open_for_reading(path);
  } catch (const hdf5::Failure& failure) {
    if (is_locked(path)) reject("is open for writing in another program");
    reject(fmt::format("is no readable HDF5 file: it is damaged or truncated ({})",
                       failure.what()));
  }
}

void ReadableFile::reject(const std::string& reason) const {
  throw InputError(path_.string() + " " + reason);
}

void ReadableFile::require(const std::string& part) const {
  const auto* const known =
      std::ranges::find_if(parts, [&](const Part& p) { return p.group == part; });
  EHDJET_EXPECTS(known != parts.end());
  if (!has(part))
    reject(fmt::format("has no {}: set {} in the scene", known->meaning, known->remedy));
}

const ReadableFile::DataSet& ReadableFile::data_set(const std::string& name) {
  if (const auto found = data_sets_.find(name); found != data_sets_.end())
    return found->second;
  if (!std::ranges::all_of(name, is_harmless))
    reject(
        "is damaged: a data set has a name with other characters than letters, digits and "
        "_-+*.^()%");
  hdf5::Handle opened = hdf5::open_rows(file_, name);
  // Files of other programs need not have units.
  std::string unit =
      hdf5::has_attribute(opened, "unit") ? hdf5::read_text_attribute(opened, "unit") : "1";
  if (!std::ranges::all_of(unit, is_harmless) || unit.size() > 64)
    reject(fmt::format("is damaged: /{} has an attribute unit that is no unit", name));
  return data_sets_[name] = {std::move(opened), std::move(unit)};
}

void ReadableFile::expect_finite(const std::string& name,
                                 const std::vector<double>& values) const {
  const auto bad =
      std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (bad != values.end())
    reject(fmt::format("is damaged: row {} of those read of /{} is {}",
                       bad - values.begin(), name, *bad));
}

std::vector<std::string> ReadableFile::names_in(const std::string& group) const {
  std::vector<std::string> names;
  const hdf5::Handle handle = hdf5::open_group(file_, group);
  hdf5::check(H5Literate(handle, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names));
  return names;
}

std::uint64_t ReadableFile::common_length(const std::string& group) {
  std::uint64_t common = std::numeric_limits<std::uint64_t>::max();
  for (const std::string& name : names_in(group))
    common = std::min(common, length(fmt::format("{}/{}", group, name)));
  return common;
}

std::vector<RunTable::Column> ReadableFile::columns(const std::string& group,
                                                    const std::vector<std::string>& names,
                                                    std::uint64_t first,
                                                    std::uint64_t count) {
  std::vector<RunTable::Column> all;
  for (const std::string& name : names) {
    const std::string path = fmt::format("{}/{}", group, name);
    all.push_back({name, data_set(path).unit, rows<double>(path, first, count)});
  }
  return all;
}

const std::vector<std::uint64_t>& ReadableFile::frame_offsets() {
  if (frame_offsets_) return *frame_offsets_;
  require("frames");
  auto offset = rows<std::uint64_t>("frames/offset", 0, length("frames/offset"));
  const std::uint64_t times = length("frames/time"),
                      beads = has("beads") ? common_length("beads") : 0;
  std::size_t frames = 0;
  while (frames < times && frames + 1 < offset.size() && offset[frames + 1] <= beads) {
    if (offset[frames + 1] <= offset[frames])
      reject(fmt::format("is damaged: frame {} of /frames/offset has no beads", frames));
    ++frames;
  }
  offset.resize(frames + 1);
  return frame_offsets_.emplace(std::move(offset));
}

} // namespace ehdjet
