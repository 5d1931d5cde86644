#pragma once

#include "ehdjet/core/checkpoint.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace ehdjet {

/// The chain at one instant as a run file has it, bead 0 (the nozzle) first. SI units.
struct Frame {
  double time = 0; ///< [s]
  std::vector<double> x, y, z, vx, vy, vz;
  std::vector<double> stress; ///< zeros if the run had none
  std::vector<double> radius, volume, mass, charge;
  std::vector<std::uint8_t> landed, embryo;

  [[nodiscard]] std::size_t beads() const { return x.size(); }
};

/// The deposited fibre as a run file has it, in the order in which beads left the chain. SI units.
struct DepositTable {
  std::vector<double> time, removal_time, x, y, z, vx, vy, vz, stress, landing_radius,
      radius, mass, charge, volume;

  [[nodiscard]] std::size_t beads() const { return time.size(); }
};

/// What each refinement did, as a run file has it. SI units.
struct RefinementTable {
  std::vector<double> time, kept, beads_before, beads_after; ///< counts as doubles
  std::vector<double> mass, charge, volume, px, py, pz, kinetic_energy, elastic_energy;
  std::vector<double> coulomb_energy; ///< empty if the run did not record it
  std::vector<double> worst_link;
};

/// Energy and momentum over time, the columns that the run had.
struct BudgetTable {
  std::vector<double> time;              ///< [s]
  std::vector<std::string> names, units; ///< of the columns, in their order
  std::vector<std::vector<double>> columns;
};

/// Samples of R = l_step/l along the jet.
struct ResolvingPowerTable {
  std::vector<double> lambda; ///< places along the jet, 0 ... 1
  std::vector<double> time;   ///< of each sample [s]
  std::vector<double> r;      ///< (time * lambda), sample after sample
};

/// Reads what a RunFile wrote; the run may have been killed or be still going on.
///
/// errors : InputError with the path if the file is missing, no HDF5 file, truncated, no run or
///          from a later version, and if a part is asked for that the run was not to write
class RunReader {
public:
  explicit RunReader(const std::filesystem::path& path);
  ~RunReader();
  RunReader(const RunReader&) = delete;
  RunReader& operator=(const RunReader&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] std::string status() const; ///< "running" if the run was killed
  [[nodiscard]] std::string message() const;
  [[nodiscard]] std::string
  attribute(const std::string& name) const; ///< provenance, by name
  [[nodiscard]] std::string scene_given() const;
  [[nodiscard]] std::string scene_resolved() const;

  [[nodiscard]] bool has_observables() const;
  [[nodiscard]] bool has_frames() const;
  [[nodiscard]] bool has_deposit() const;
  [[nodiscard]] bool has_refinements() const;
  [[nodiscard]] bool has_budget() const;
  [[nodiscard]] bool has_resolving_power() const;

  /// Names of the observables, alphabetically.
  [[nodiscard]] std::vector<std::string> columns() const;
  /// One observable at all its times; counts come out as doubles, exact up to 2^53.
  [[nodiscard]] std::vector<double> observable(const std::string& column) const;

  [[nodiscard]] std::vector<double> frame_times() const;
  [[nodiscard]] Frame frame(std::size_t index) const;
  /// Index of the frame nearest to `time`; of two equally near ones the earlier.
  [[nodiscard]] std::size_t nearest_frame(double time) const;

  [[nodiscard]] DepositTable deposit() const;
  [[nodiscard]] RefinementTable refinements() const;
  [[nodiscard]] BudgetTable budget() const;
  [[nodiscard]] ResolvingPowerTable resolving_power() const;
  [[nodiscard]] Checkpoint checkpoint() const; ///< the last one

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace ehdjet
