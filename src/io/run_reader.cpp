#include "ehdjet/io/run_reader.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <sstream>
#include <system_error>

#include "checkpoint_slots.hpp"
#include "hdf5.hpp"

namespace ehdjet {

using hdf5::Handle;

namespace {

constexpr std::uint64_t newest_version = 1;

herr_t add_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> names_in(hid_t file, const char* group) {
  std::vector<std::string> names;
  const Handle handle(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose);
  hdf5::check(H5Literate(handle, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_name, &names));
  return names;
}

} // namespace

struct RunReader::Impl {
  std::filesystem::path path;
  Handle file;
  std::map<std::string, Handle> data_sets; // kept open: each holds its last chunks unpacked

  hid_t data_set(const std::string& name) {
    auto found = data_sets.find(name);
    if (found == data_sets.end()) {
      found =
          data_sets
              .emplace(name, Handle(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose))
              .first;
    }
    return found->second;
  }
  template <class T>
  std::vector<T> rows(const std::string& name, std::uint64_t first, std::uint64_t count) {
    return hdf5::read_rows<T>(data_set(name), first, count);
  }
  // Rows that all data sets of a group have: a run killed within a commit may have left some of
  // them longer by what the next flush was about to add.
  hsize_t common_length(const std::string& group) {
    hsize_t common = std::numeric_limits<hsize_t>::max();
    for (const std::string& name : names_in(file, group.c_str())) {
      common = std::min(common, hdf5::length(data_set(fmt::format("{}/{}", group, name))));
    }
    return common;
  }

  void open() {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) reject("does not exist");
    if (std::filesystem::is_directory(path, ignored)) reject("is a folder, not a run file");
    const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
    if (is_hdf5 < 0) reject("cannot be opened");
    if (is_hdf5 == 0) reject("is not an HDF5 file");
    try {
      file = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
    } catch (const hdf5::Failure& failure) {
      reject(
          fmt::format("cannot be opened, it is damaged or truncated ({})", failure.what()));
    }
    if (!hdf5::has_attribute(file, "format")
        || hdf5::read_text_attribute(file, "format") != "ehdjet run") {
      reject("is not an ehdjet run: it has no attribute format = \"ehdjet run\"");
    }
    const std::uint64_t version = hdf5::read_count_attribute(file, "format_version");
    if (version > newest_version) {
      reject(fmt::format("has format version {}; this ehdjet reads up to {}", version,
                         newest_version));
    }
  }

  [[noreturn]] void reject(const std::string& reason) const {
    throw InputError(path.string() + " " + reason);
  }

  template <class Read>
  auto guard(Read&& read) const {
    try {
      return read();
    } catch (const hdf5::Failure& failure) {
      reject(
          fmt::format("cannot be read, it is damaged or truncated ({})", failure.what()));
    }
  }

  [[nodiscard]] bool has(const char* part) const {
    return guard([&] { return hdf5::has(file, part); });
  }
  void require(const char* part, const char* what, const char* remedy) const {
    if (!has(part)) reject(fmt::format("has no {}: set {} in the scene", what, remedy));
  }
  hsize_t frames() { // the offset that ends a frame is written last
    require("frames", "frames", "output.frames");
    const hsize_t offsets = hdf5::length(data_set("frames/offset"));
    return std::min(hdf5::length(data_set("frames/time")), offsets > 0 ? offsets - 1 : 0);
  }
};

RunReader::RunReader(const std::filesystem::path& path)
    : impl_(std::make_unique<Impl>()) {
  hdf5::silence_errors();
  impl_->path = path;
  impl_->guard([&] { impl_->open(); });
}

RunReader::~RunReader() = default;

const std::filesystem::path& RunReader::path() const {
  return impl_->path;
}

std::string RunReader::status() const {
  return attribute("status");
}
std::string RunReader::message() const {
  return attribute("message");
}

std::string RunReader::attribute(const std::string& name) const {
  return impl_->guard([&] { return hdf5::read_text_attribute(impl_->file, name.c_str()); });
}

std::string RunReader::scene_given() const {
  return impl_->guard([&] { return hdf5::read_text(impl_->file, "scene/given"); });
}

std::string RunReader::scene_resolved() const {
  return impl_->guard([&] { return hdf5::read_text(impl_->file, "scene/resolved"); });
}

bool RunReader::has_observables() const {
  return impl_->has("observables");
}
bool RunReader::has_frames() const {
  return impl_->has("frames");
}
bool RunReader::has_deposit() const {
  return impl_->has("deposit");
}

bool RunReader::has_refinements() const {
  return impl_->has("refinements");
}
bool RunReader::has_budget() const {
  return impl_->has("budget");
}
bool RunReader::has_resolving_power() const {
  return impl_->has("resolving_power");
}

std::vector<std::string> RunReader::columns() const {
  impl_->require("observables", "observables", "output.observables");
  return impl_->guard([&] { return names_in(impl_->file, "observables"); });
}

std::vector<double> RunReader::observable(const std::string& column) const {
  impl_->require("observables", "observables", "output.observables");
  return impl_->guard([&] {
    if (!hdf5::has(impl_->file, ("observables/" + column).c_str())) {
      impl_->reject("has no observable " + column);
    }
    return impl_->rows<double>("observables/" + column, 0,
                               impl_->common_length("observables"));
  });
}

std::vector<double> RunReader::frame_times() const {
  return impl_->guard(
      [&] { return impl_->rows<double>("frames/time", 0, impl_->frames()); });
}

Frame RunReader::frame(std::size_t index) const {
  return impl_->guard([&] {
    Impl& file = *impl_;
    EHDJET_EXPECTS(index < file.frames());
    const auto offset = file.rows<std::uint64_t>("frames/offset", index, 2);
    const std::uint64_t first = offset[0], beads = offset[1] - offset[0];
    const auto real = [&](const char* name) {
      return file.rows<double>(name, first, beads);
    };
    Frame frame;
    frame.time = file.rows<double>("frames/time", index, 1)[0];
    frame.x = real("beads/x"), frame.y = real("beads/y"), frame.z = real("beads/z");
    frame.vx = real("beads/vx"), frame.vy = real("beads/vy"), frame.vz = real("beads/vz");
    frame.stress = hdf5::has(file.file, "beads/stress") ? real("beads/stress")
                                                        : std::vector<double>(beads);
    frame.radius = real("beads/radius"), frame.volume = real("beads/volume");
    frame.mass = real("beads/mass"), frame.charge = real("beads/charge");
    frame.landed = file.rows<std::uint8_t>("beads/landed", first, beads);
    frame.embryo = file.rows<std::uint8_t>("beads/embryo", first, beads);
    return frame;
  });
}

std::size_t RunReader::nearest_frame(double time) const {
  const std::vector<double> times = frame_times();
  if (times.empty()) impl_->reject("has no frame yet");
  const auto later = [&](double a, double b) {
    return std::abs(a - time) < std::abs(b - time);
  };
  return static_cast<std::size_t>(std::min_element(times.begin(), times.end(), later)
                                  - times.begin());
}

DepositTable RunReader::deposit() const {
  impl_->require("deposit", "deposit", "output.deposit = true");
  return impl_->guard([&] {
    const hsize_t beads = impl_->common_length("deposit");
    const auto column = [&](const char* name) {
      return impl_->rows<double>(std::string("deposit/") + name, 0, beads);
    };
    return DepositTable{column("time"),   column("removal_time"),
                        column("x"),      column("y"),
                        column("z"),      column("vx"),
                        column("vy"),     column("vz"),
                        column("stress"), column("landing_radius"),
                        column("radius"), column("mass"),
                        column("charge"), column("volume")};
  });
}

RefinementTable RunReader::refinements() const {
  impl_->require("refinements", "record of refinements", "output.refinements");
  return impl_->guard([&] {
    const hsize_t rows = impl_->common_length("refinements");
    const auto column = [&](const char* name) {
      return impl_->rows<double>(std::string("refinements/") + name, 0, rows);
    };
    const bool with_coulomb = hdf5::has(impl_->file, "refinements/coulomb_energy_change");
    return RefinementTable{.time = column("time"),
                           .kept = column("kept"),
                           .beads_before = column("beads_before"),
                           .beads_after = column("beads_after"),
                           .mass = column("mass_change"),
                           .charge = column("charge_change"),
                           .volume = column("volume_change"),
                           .px = column("momentum_change_x"),
                           .py = column("momentum_change_y"),
                           .pz = column("momentum_change_z"),
                           .kinetic_energy = column("kinetic_energy_change"),
                           .elastic_energy = column("elastic_energy_change"),
                           .coulomb_energy = with_coulomb ? column("coulomb_energy_change")
                                                          : std::vector<double>{},
                           .worst_link = column("worst_link")};
  });
}

BudgetTable RunReader::budget() const {
  impl_->require("budget", "budget of energy and momentum", "output.budget");
  return impl_->guard([&] {
    Impl& file = *impl_;
    const Handle group(H5Gopen2(file.file, "budget", H5P_DEFAULT), H5Gclose);
    const hsize_t rows = file.common_length("budget");
    BudgetTable table{.time = file.rows<double>("budget/time", 0, rows),
                      .names = {},
                      .units = {},
                      .columns = {}};
    std::istringstream names(hdf5::read_text_attribute(group, "columns"));
    for (std::string name; std::getline(names, name, ',');) {
      const std::string path = "budget/" + name;
      table.names.push_back(name);
      table.units.push_back(hdf5::read_text_attribute(file.data_set(path), "unit"));
      table.columns.push_back(file.rows<double>(path, 0, rows));
    }
    return table;
  });
}

Checkpoint RunReader::checkpoint() const {
  return impl_->guard([&] {
    const auto checkpoint = hdf5::read_current_slot(impl_->file);
    if (!checkpoint)
      impl_->reject("has no checkpoint: set output.checkpoints in the scene, to less than "
                    "run.end_time");
    return *checkpoint;
  });
}

ResolvingPowerTable RunReader::resolving_power() const {
  impl_->require("resolving_power", "resolving power", "output.resolving_power");
  return impl_->guard([&] {
    Impl& file = *impl_;
    const hsize_t places = hdf5::length(file.data_set("resolving_power/lambda"));
    const hsize_t samples = // the time of a sample is written last
        std::min(hdf5::length(file.data_set("resolving_power/time")),
                 hdf5::length(file.data_set("resolving_power/r")) / places);
    return ResolvingPowerTable{
        .lambda = file.rows<double>("resolving_power/lambda", 0, places),
        .time = file.rows<double>("resolving_power/time", 0, samples),
        .r = file.rows<double>("resolving_power/r", 0, samples * places)};
  });
}

} // namespace ehdjet
