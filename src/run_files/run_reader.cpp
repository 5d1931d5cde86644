#include "ehdjet/run_files/run_reader.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>

#include "checkpoint_slots.hpp"
#include "readable_file.hpp"

namespace ehdjet {
namespace {

constexpr std::uint64_t newest_version = 1;

// The names of the columns of a part, in the order of RunReader::table.
std::vector<std::string> names_of(const ReadableFile& file, const std::string& part) {
  const hdf5::Handle group(H5Gopen2(file.file(), part.c_str(), H5P_DEFAULT), H5Gclose);
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
  if (found == nullptr)
    throw InputError(fmt::format("the run file has no column {}", name));
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
    return file_->rows<double>("frames/time", 0, file_->frame_offsets().size() - 1);
  });
}

Frame FrameReader::frame(std::size_t index) const {
  return file_->guard([&] {
    const auto& offset = file_->frame_offsets();
    EHDJET_EXPECTS(index + 1 < offset.size());
    Frame frame;
    frame.time = file_->rows<double>("frames/time", index, 1)[0];
    frame.columns = file_->columns("beads", file_->names_in("beads"), offset[index],
                                   offset[index + 1] - offset[index]);
    return frame;
  });
}

std::size_t FrameReader::nearest_frame(std::optional<double> time) const {
  const std::vector<double> times = frame_times();
  if (times.empty()) file_->reject("has no frame yet");
  if (!time) return times.size() - 1;
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
    if (version > newest_version)
      file_->reject(fmt::format("has format version {}; this ehdjet reads up to {}",
                                version, newest_version));
  });
}

std::string RunReader::attribute(const std::string& name) const {
  return file_->guard(
      [&] { return hdf5::read_text_attribute(file_->file(), name.c_str()); });
}

std::string RunReader::scene(const std::string& form) const {
  return file_->guard(
      [&] { return hdf5::read_text(file_->file(), ("scene/" + form).c_str()); });
}

bool RunReader::has(const std::string& part) const {
  return file_->guard([&] { return file_->has(part); });
}

RunTable RunReader::table(const std::string& part) const {
  return file_->guard([&] {
    file_->require(part);
    return RunTable{
        file_->columns(part, names_of(*file_, part), 0, file_->common_length(part))};
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
    return ResolvingPowerTable{
        .lambda = file_->rows<double>("resolving_power/lambda", 0, places),
        .time = file_->rows<double>("resolving_power/time", 0, samples),
        .r = file_->rows<double>("resolving_power/r", 0, samples * places)};
  });
}

Checkpoint RunReader::checkpoint() const {
  return file_->guard([&] {
    const auto checkpoint = hdf5::read_current_slot(file_->file());
    if (!checkpoint)
      file_->reject("has no checkpoint: set output.checkpoints in the scene, to less than "
                    "run.end_time");
    return *checkpoint;
  });
}

} // namespace ehdjet
