#include "checkpoint_slots.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace ehdjet::hdf5 {
namespace {

constexpr const char* group_name = "checkpoint";
constexpr const char* current = "current";
constexpr const char* crc32 = "crc32";
constexpr hsize_t chunk_rows = 4096; // 32 KiB

std::string slot_name(std::uint64_t slot) {
  return slot == 0 ? "a" : "b";
}

// The data set never becomes shorter, because HDF5 would not reuse the space.
template <class T>
void write_list(hid_t group, const char* name, const std::vector<T>& values) {
  const Handle dataset = open_rows(group, name);
  const hsize_t rows = values.size(), extent = std::max(length(dataset), rows);
  check(H5Dset_extent(dataset, &extent));
  write_rows(dataset, native(T{}), 0, rows, values.data());
  write_attribute(dataset, crc32, checksum(std::span(values)));
}

template <class T>
void expect_checksum(hid_t dataset, std::span<const T> values) {
  if (!has_attribute(dataset, crc32))
    refuse(dataset,
           "has no checksum crc32: it is damaged, or of an earlier version of ehdjet, "
           "with which it has to be continued");
  if (read_count_attribute(dataset, crc32) != checksum(values))
    refuse(dataset, "has other values than were written: its checksum differs");
}

template <class T>
std::vector<T> read_list(hid_t group, const char* name, hsize_t rows) {
  const Handle dataset = open_rows(group, name);
  auto values = read_rows<T>(dataset, 0, rows);
  expect_checksum(dataset, std::span<const T>(values));
  return values;
}

std::vector<std::string> read_names(hid_t group) {
  const std::string text = read_text(group, "names");
  const Handle dataset(H5Dopen2(group, "names", H5P_DEFAULT), H5Dclose);
  expect_checksum(dataset, std::span<const char>(text));
  std::istringstream lines(text);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  if (std::ranges::adjacent_find(names, std::greater_equal{}) != names.end())
    refuse(dataset, "is not in order, or has a name twice");
  return names;
}

std::uint64_t read_current(hid_t group) {
  const std::uint64_t slot = read_count_attribute(group, current);
  if (slot > 1)
    refuse(group, fmt::format("has current = {}, which is neither 0 nor 1", slot));
  return slot;
}

std::string names_of(const Checkpoint& checkpoint) {
  std::string names;
  for (const auto& [name, list] : checkpoint) names += name + '\n';
  return names;
}

void create_slots(hid_t file, const std::string& names) {
  const Handle group = create_group(file, group_name);
  write_text(group, "names", names);
  write_attribute(Handle(H5Dopen2(group, "names", H5P_DEFAULT), H5Dclose), crc32,
                  checksum(std::span<const char>(names)));
  for (const std::uint64_t slot : {0U, 1U}) {
    const Handle part = create_group(group, slot_name(slot).c_str());
    // Without compression a chunk keeps its place in the file when it changes.
    create_rows(part, "offset", native(std::uint64_t{}), chunk_rows, Packing::none);
    create_rows(part, "numbers", native(double{}), chunk_rows, Packing::none);
  }
}

} // namespace

std::uint64_t fill_free_slot(hid_t file, const Checkpoint& checkpoint) {
  const std::string names = names_of(checkpoint);
  if (!has(file, group_name)) create_slots(file, names);
  const Handle group = open_group(file, group_name);
  if (read_text(group, "names") != names)
    throw Failure("this checkpoint has other lists than the one before");
  const std::uint64_t slot = has_attribute(group, current) ? 1 - read_current(group) : 0;
  std::vector<std::uint64_t> offset{0};
  std::vector<double> numbers;
  for (const auto& [name, list] : checkpoint) {
    numbers.insert(numbers.end(), list.begin(), list.end());
    offset.push_back(numbers.size());
  }
  const Handle part = open_group(group, slot_name(slot));
  write_list(part, "offset", offset);
  write_list(part, "numbers", numbers);
  return slot;
}

void make_current(hid_t file, std::uint64_t slot) {
  write_attribute(open_group(file, group_name), current, slot);
}

std::optional<Checkpoint> read_current_slot(hid_t file) {
  if (!has(file, group_name)) return std::nullopt;
  const Handle group = open_group(file, group_name);
  if (!has_attribute(group, current)) return std::nullopt;
  const Handle part = open_group(group, slot_name(read_current(group)));
  const auto names = read_names(group);
  const auto offset = read_list<std::uint64_t>(part, "offset", names.size() + 1);
  if (offset.front() != 0 || !std::ranges::is_sorted(offset))
    refuse(part, "has an offset that is not the end of the list before");
  const auto numbers = read_list<double>(part, "numbers", offset.back());
  Checkpoint checkpoint;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto at = [&](std::size_t i) {
      return numbers.begin() + static_cast<std::ptrdiff_t>(i);
    };
    checkpoint[names[k]].assign(at(offset[k]), at(offset[k + 1]));
  }
  return checkpoint;
}

} // namespace ehdjet::hdf5
