#include "ehdjet/run_files/run_reader.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>

#include "checkpoint_slots.hpp"
#include "file_driver.hpp"
#include "readable_file.hpp"

namespace ehdjet {
namespace {

constexpr std::uint64_t newest_version = 1;

// The names of the columns of a part, in the order of RunReader::table.
std::vector<std::string> names_of(const ReadableFile& file, const std::string& part) {
  const hdf5::Handle group = hdf5::open_group(file.file(), part);
  if (!hdf5::has_attribute(group, "columns")) return file.names_in(part);
  std::vector<std::string> names{"time"};
  std::istringstream given(hdf5::read_text_attribute(group, "columns"));
  for (std::string name; std::getline(given, name, ',');) names.push_back(name);
  return names;
}

} // namespace

const RunTable::Column* RunTable::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

const std::vector<double>& RunTable::operator[](std::string_view name) const {
  const Column* found = find(name);
  if (found == nullptr) throw InputError(fmt::format("{} has no column {}", origin, name));
  return found->values;
}

FrameReader::FrameReader(const std::filesystem::path& path)
    : file_(std::make_unique<ReadableFile>(path)) {}

FrameReader::~FrameReader() = default;

const std::filesystem::path& FrameReader::path() const {
  return file_->path();
}

std::vector<double> FrameReader::frame_times() const {
  return file_->guard([&] {
    auto times = file_->rows<double>("frames/time", 0, file_->frame_offsets().size() - 1);
    file_->expect_finite("frames/time", times);
    return times;
  });
}

Frame FrameReader::frame(std::size_t index) const {
  return file_->guard([&] {
    const auto& offset = file_->frame_offsets();
    EHDJET_EXPECTS(index + 1 < offset.size());
    Frame frame;
    frame.time = file_->rows<double>("frames/time", index, 1)[0];
    frame.origin = file_->path().string() + ": /beads";
    frame.columns = file_->columns("beads", file_->names_in("beads"), offset[index],
                                   offset[index + 1] - offset[index]);
    for (const RunTable::Column& c : frame.columns)
      if (c.name != "radius") // infinite where a link has no length
        file_->expect_finite("beads/" + c.name, c.values);
    return frame;
  });
}

std::vector<BeadRange> FrameReader::frame_rows() const {
  return file_->guard([&] {
    const auto& offset = file_->frame_offsets();
    std::vector<BeadRange> rows;
    for (std::size_t k = 0; k + 1 < offset.size(); ++k)
      rows.push_back({offset[k], offset[k + 1]});
    return rows;
  });
}

std::size_t FrameReader::nearest_frame(std::optional<double> time) const {
  const std::vector<double> times = frame_times();
  if (times.empty()) file_->reject("has no frame yet");
  if (!time) return times.size() - 1;
  const double first = times.front(), last = times.back(),
               gap = times.size() > 1 ? last - times[times.size() - 2] : 0,
               round_off = 1e-9 * std::max(std::abs(first), std::abs(last));
  if (!(*time >= first - round_off && *time <= last + gap + round_off)) // false for a NaN
    file_->reject(
        fmt::format("has no frame at t = {} s: its {} frames are from t = {:.9g} s to "
                    "{:.9g} s",
                    *time, times.size(), first, last));
  const auto nearer = [&](double a, double b) {
    return std::abs(a - *time) < std::abs(b - *time);
  };
  return static_cast<std::size_t>(std::ranges::min_element(times, nearer) - times.begin());
}

RunReader::RunReader(const std::filesystem::path& path)
    : FrameReader(path) {
  file_->guard([&] {
    const hid_t file = file_->file();
    if (!hdf5::has_attribute(file, "format")
        || hdf5::read_text_attribute(file, "format") != "ehdjet run")
      file_->reject("is not an ehdjet run: it has no attribute format = \"ehdjet run\"");
    const std::uint64_t version = hdf5::read_count_attribute(file, "format_version");
    if (version < 1 || version > newest_version)
      file_->reject(fmt::format("has format version {}; this ehdjet reads up to {}",
                                version, newest_version));
  });
}

std::string RunReader::attribute(const std::string& name) const {
  return file_->guard(
      [&] { return hdf5::read_text_attribute(file_->file(), name.c_str()); });
}

bool RunReader::has_attribute(const std::string& name) const {
  return file_->guard([&] { return hdf5::has_attribute(file_->file(), name.c_str()); });
}

bool RunReader::is_being_written() const {
  return hdf5::ReplaceLock(path().c_str()).is_refused();
}

std::string RunReader::scene(const std::string& form) const {
  return file_->guard(
      [&] { return hdf5::read_text(file_->file(), ("scene/" + form).c_str()); });
}

std::map<std::string, double> RunReader::statistics() const {
  return file_->guard([&]() -> std::map<std::string, double> {
    if (!file_->has("statistics")) return {};
    const hdf5::Handle group(H5Gopen2(file_->file(), "statistics", H5P_DEFAULT), H5Gclose);
    return hdf5::read_number_attributes(group);
  });
}

bool RunReader::has(const std::string& part) const {
  return file_->guard([&] { return file_->has(part); });
}

RunTable RunReader::table(const std::string& part) const {
  return file_->guard([&] {
    file_->require(part);
    RunTable table{
        file_->columns(part, names_of(*file_, part), 0, file_->common_length(part)),
        fmt::format("{}: /{}", file_->path().string(), part)};
    if (const RunTable::Column* time = table.find("time"))
      file_->expect_finite(part + "/time", time->values);
    return table;
  });
}

std::vector<double> RunReader::column(const std::string& part,
                                      const std::string& name) const {
  return file_->guard([&] {
    file_->require(part);
    return file_->rows<double>(part + "/" + name, 0, file_->common_length(part));
  });
}

ResolvingPowerTable RunReader::resolving_power() const {
  return file_->guard([&] {
    file_->require("resolving_power");
    const std::uint64_t places = file_->length("resolving_power/lambda");
    const std::uint64_t samples = // the time of a sample is written last
        std::min(file_->length("resolving_power/time"),
                 file_->length("resolving_power/r") / std::max<std::uint64_t>(places, 1));
    ResolvingPowerTable table{
        .lambda = file_->rows<double>("resolving_power/lambda", 0, places),
        .time = file_->rows<double>("resolving_power/time", 0, samples),
        .r = file_->rows<double>("resolving_power/r", 0, samples * places)};
    file_->expect_finite("resolving_power/time", table.time);
    return table;
  });
}

std::optional<Checkpoint> RunReader::last_checkpoint() const {
  return file_->guard([&] { return hdf5::read_current_slot(file_->file()); });
}

Checkpoint RunReader::checkpoint() const {
  auto checkpoint = last_checkpoint();
  if (!checkpoint)
    file_->reject("has no checkpoint: set output.checkpoints in the scene, to less than "
                  "run.end_time");
  return *std::move(checkpoint);
}

} // namespace ehdjet
