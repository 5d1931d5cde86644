#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/run_files/frame_reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace ehdjet {

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
class RunReader final : public FrameReader {
public:
  explicit RunReader(const std::filesystem::path& path);

  [[nodiscard]] std::string status() const; ///< "running" if the run was killed
  [[nodiscard]] std::string message() const;
  [[nodiscard]] std::string
  attribute(const std::string& name) const; ///< provenance, by name
  [[nodiscard]] std::string scene_given() const;
  [[nodiscard]] std::string scene_resolved() const;

  /// Whether the run wrote that part: "observables", "frames", "deposit", "refinements", "budget",
  /// "resolving_power".
  [[nodiscard]] bool has(const std::string& part) const;
  /// All columns of a part, but frames and resolving power: in the order that the file gives, or
  /// else alphabetically.
  [[nodiscard]] RunTable table(const std::string& part) const;
  /// One of those columns.
  [[nodiscard]] std::vector<double> column(const std::string& part,
                                           const std::string& name) const;
  [[nodiscard]] ResolvingPowerTable resolving_power() const;
  [[nodiscard]] Checkpoint checkpoint() const; ///< the last one
};

} // namespace ehdjet
