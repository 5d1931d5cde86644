#include "ehdjet/core/error.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "chain_formats.hpp"

namespace ehdjet {
namespace {

/// An HDF5 identifier with one owner.
class Handle {
public:
  Handle(hid_t id, herr_t (*close)(hid_t))
      : id_(id)
      , close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] bool valid() const { return id_ >= 0; }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its errors to stderr unless this is switched off; our messages explain them.
class SilentErrors {
public:
  SilentErrors() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~SilentErrors() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

template <class T>
hid_t memory_type();
template <>
hid_t memory_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t memory_type<std::uint64_t>() {
  return H5T_NATIVE_UINT64;
}

class ChainHdf5 {
public:
  explicit ChainHdf5(const std::filesystem::path& file)
      : name_(file.string())
      , file_(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (!file_.valid())
      refuse("is no readable HDF5 file (damaged, or still being written by a run)");
  }

  ChainBeads read(std::optional<double> time) const {
    const auto times = whole<double>("/frames/time");
    const auto offset = whole<std::uint64_t>("/frames/offset");
    if (times.empty()) refuse("has no frames: the run that wrote it had no output.frames");
    if (offset.size() != times.size() + 1 || !std::ranges::is_sorted(offset))
      refuse(fmt::format("/frames/offset has {} entries for {} frames, or they decrease",
                         offset.size(), times.size()));
    const std::size_t frame = time ? nearest(times, *time) : times.size() - 1;
    ChainBeads beads = read_frame(offset[frame], offset[frame + 1] - offset[frame]);
    check_chain(beads, [&](std::size_t bead, const char*) {
      return fmt::format("{}: frame {} (t = {} s), bead {}", name_, frame, times[frame],
                         bead);
    });
    return beads;
  }

private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("{}: {}", name_, why));
  }

  static std::size_t nearest(const std::vector<double>& times, double time) {
    const auto further = [time](double a, double b) {
      return std::abs(a - time) < std::abs(b - time);
    };
    return static_cast<std::size_t>(std::ranges::min_element(times, further)
                                    - times.begin());
  }

  [[nodiscard]] bool has(const char* path) const {
    return H5Lexists(file_, path, H5P_DEFAULT) > 0;
  }

  [[nodiscard]] ChainBeads read_frame(hsize_t first, hsize_t count) const {
    ChainBeads beads;
    for (const auto& column : chain_columns) {
      const std::string path = fmt::format("/beads/{}", column.hdf5);
      beads.*column.values = column.hdf5_required || has(path.c_str())
                                 ? rows<double>(path, first, count)
                                 : std::vector<double>(count, 0.0);
    }
    if (!has("/beads/embryo")) return beads;
    const auto embryo = rows<double>("/beads/embryo", first, count);
    for (std::size_t i = embryo.size(); i-- > 0;)
      if (embryo[i] != 0)
        for (const auto& column : chain_columns) {
          auto& values = beads.*column.values;
          values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
        }
    return beads;
  }

  template <class T>
  [[nodiscard]] std::vector<T> whole(const std::string& path) const {
    return rows<T>(path, 0, H5S_UNLIMITED);
  }

  /// Rows first, first + 1, ... of a flat dataset; all that follow if count is H5S_UNLIMITED.
  template <class T>
  [[nodiscard]] std::vector<T> rows(const std::string& path, hsize_t first,
                                    hsize_t count) const {
    const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.valid()) refuse(fmt::format("has no dataset {}", path));
    const Handle space(H5Dget_space(dataset), H5Sclose);
    if (H5Sget_simple_extent_ndims(space) != 1)
      refuse(fmt::format("{} is no flat array", path));
    hsize_t size = 0;
    H5Sget_simple_extent_dims(space, &size, nullptr);
    if (count == H5S_UNLIMITED) count = size;
    if (first > size || count > size - first)
      refuse(fmt::format("{} has {} rows, but /frames/offset asks for {} from row {}", path,
                         size, count, first));
    std::vector<T> values(count);
    if (count == 0) return values;
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr) < 0
        || H5Dread(dataset, memory_type<T>(), memory, space, H5P_DEFAULT, values.data())
               < 0)
      refuse(fmt::format("cannot read {} as numbers", path));
    return values;
  }

  std::string name_;
  Handle file_;
};

} // namespace

ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time) {
  const SilentErrors silent;
  return ChainHdf5(file).read(time);
}

} // namespace ehdjet
