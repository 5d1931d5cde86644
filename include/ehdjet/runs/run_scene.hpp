#pragma once

#include "ehdjet/budget/effective_tension.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace ehdjet {

/// What may be said about a run beside its scene.
struct RunOptions {
  bool overwrite = false; ///< an existing file of that name
  /// Number of threads during the run; by default that of the scene, or else OpenMP's.
  std::optional<std::size_t> threads;
  /// A run file of the same scene, from whose last checkpoint the run goes on.
  std::optional<std::filesystem::path> continue_from;
  std::string scene_file; ///< where the scene was read from, for the run file
  /// Further root attributes of the run file, beside those of `build_environment`.
  std::map<std::string, std::string> provenance;
  /// Force terms, events and observers that the scene does not know of. They are part of the
  /// caller's program: a run that goes on from a checkpoint needs the same ones.
  Extras extras;
  /// Called once, after the file has been created and before the first step.
  std::function<void(Simulation&)> started;
  /// Asked after each step: why the run is to stop, or nullptr.
  std::function<const char*()> interrupted;
};

/// The end of a run.
struct RunResult {
  std::string status;  ///< "complete" or "interrupted", as in the file
  std::string message; ///< why it was interrupted, and when
  JetState jet;
  RunStatistics statistics;
  Ledger ledger;
  std::string coulomb_method; ///< what the solver has done; empty for the direct sum
  std::optional<EffectiveTension::Summary> tension =
      {}; ///< at the end; only with a near field
};

/// Version, commit, compiler, instruction set and threads of this library, by name: what every run
/// file records.
std::map<std::string, std::string> build_environment();

/// Simulates a scene and writes what its [output] asks for into a run file. The file has the
/// status of the result, or "failed" and the message if an error ends the run.
///
/// errors : InputError before the first step if the scene cannot be built, the file cannot be
///          created or the run cannot be continued;
///          RunError if the run fails; its message says where the file is, which has everything
///          up to then
RunResult run_scene(const Scene& scene, const std::filesystem::path& file,
                    RunOptions options = {});

} // namespace ehdjet
