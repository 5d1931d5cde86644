#include "checkpoint_slots.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace ehdjet::hdf5 {
namespace {

constexpr const char* group_name = "checkpoint";
constexpr const char* current = "current";
constexpr hsize_t chunk_rows = 4096; // 32 KiB

std::string slot_name(std::uint64_t slot) {
  return slot == 0 ? "a" : "b";
}

Handle open_group(hid_t parent, const char* name) {
  return {H5Gopen2(parent, name, H5P_DEFAULT), H5Gclose};
}

// The data set never becomes shorter, because HDF5 would not reuse the space.
template <class T>
void write_list(hid_t group, const char* name, const std::vector<T>& values) {
  const Handle dataset(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  const hsize_t rows = values.size(), extent = std::max(length(dataset), rows);
  check(H5Dset_extent(dataset, &extent));
  write_rows(dataset, native(T{}), 0, rows, values.data());
}

template <class T>
std::vector<T> read_list(hid_t group, const char* name, hsize_t rows) {
  return read_rows<T>(Handle(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose), 0, rows);
}

void create_slots(hid_t file, const Checkpoint& checkpoint) {
  const Handle group = create_group(file, group_name);
  std::string names;
  for (const auto& [name, list] : checkpoint) names += name + '\n';
  write_text(group, "names", names);
  for (const std::uint64_t slot : {0U, 1U}) {
    const Handle part = create_group(group, slot_name(slot).c_str());
    // Without compression a chunk keeps its place in the file when it changes.
    create_rows(part, "offset", native(std::uint64_t{}), chunk_rows, Packing::none);
    create_rows(part, "numbers", native(double{}), chunk_rows, Packing::none);
  }
}

} // namespace

std::uint64_t fill_free_slot(hid_t file, const Checkpoint& checkpoint) {
  if (!has(file, group_name)) create_slots(file, checkpoint);
  const Handle group = open_group(file, group_name);
  const std::uint64_t slot =
      has_attribute(group, current) ? 1 - read_count_attribute(group, current) : 0;
  std::vector<std::uint64_t> offset{0};
  std::vector<double> numbers;
  for (const auto& [name, list] : checkpoint) {
    numbers.insert(numbers.end(), list.begin(), list.end());
    offset.push_back(numbers.size());
  }
  const Handle part = open_group(group, slot_name(slot).c_str());
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
  const Handle part =
      open_group(group, slot_name(read_count_attribute(group, current)).c_str());
  std::istringstream names(read_text(group, "names"));
  std::vector<std::string> name;
  for (std::string line; std::getline(names, line);) name.push_back(line);
  const auto offset = read_list<std::uint64_t>(part, "offset", name.size() + 1);
  const auto numbers = read_list<double>(part, "numbers", offset.back());
  Checkpoint checkpoint;
  for (std::size_t k = 0; k < name.size(); ++k) {
    if (offset[k] > offset[k + 1]) throw Failure("its checkpoint has a negative length");
    const auto at = [&](std::size_t i) {
      return numbers.begin() + static_cast<std::ptrdiff_t>(i);
    };
    checkpoint[name[k]].assign(at(offset[k]), at(offset[k + 1]));
  }
  return checkpoint;
}

} // namespace ehdjet::hdf5
