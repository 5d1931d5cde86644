#pragma once

#include "ehdjet/budget/effective_tension.hpp"
#include "ehdjet/observers/dry_fibre.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ehdjet {

/// Options of a run that are not in its scene.
struct RunOptions {
  bool overwrite = false; ///< overwrites an existing file of that name
  /// Number of threads during the run; by default that of the scene, or otherwise of OpenMP.
  std::optional<std::size_t> threads;
  /// A run file of the same scene. The run continues from its last checkpoint.
  std::optional<std::filesystem::path> continue_from;
  /// Goes on in the file itself, if it holds a run of the same scene that has been stopped: from its last
  /// checkpoint, or from the start if it has none. Rows behind the checkpoint are written anew. If there is
  /// no file the run starts; if the file is complete nothing is done.
  bool resume = false;
  std::string scene_file; ///< path of the scene, for the run file
  /// Further root attributes of the run file, besides those of `build_environment`.
  std::map<std::string, std::string> provenance;
  /// Force terms, events and observers of the calling program. To continue a run from a checkpoint,
  /// the program must pass the same ones.
  Extras extras;
  /// Called once, after the file has been created and before the first step.
  std::function<void(Simulation&)> started;
  /// The same for a scene with [array].
  std::function<void(ArraySimulation&)> array_started;
  /// Called before the first step with what the user should know: that a run goes on with another number of threads.
  std::function<void(const std::string&)> note;
  /// Called after each step and before a step is attempted again. Returns the reason to stop the run, or nullptr. A checkpoint is made
  /// before it is asked for at the end of a step.
  std::function<const char*()> interrupted;
  /// Called after each step. Whether a checkpoint is wanted at once.
  std::function<bool()> checkpoint_wanted;
};

/// The end of a run.
struct RunResult {
  std::filesystem::path
      file; ///< the run file, where it is now: it may have been renamed during the run
  std::string status;  ///< "complete" or "interrupted", as in the file
  std::string message; ///< the reason and time of an interruption
  JetState jet;        ///< of a single jet
  RunStatistics statistics;
  Ledger ledger;              ///< of all jets of an array: see `sum_of`
  std::size_t threads = 1;    ///< that ran
  std::string coulomb_method; ///< description of the solver; empty for the direct sum
  /// At the end; only with a near field.
  std::optional<EffectiveTension::Summary> tension = {};
  /// What a drying jet has laid down in the second half of the run; not of an array.
  std::optional<DryFibre::Summary> fibre = {};
  std::vector<JetState> array = {}; ///< the jets of an array, from its axis
  /// The file was complete before: nothing has been done, and there are only status and message.
  bool was_complete = false;
};

/// Version, commit, compiler, instruction set and threads of this library, by name. Every run file
/// records them.
std::map<std::string, std::string> build_environment();

/// Simulates a scene and writes the parts that its [output] asks for into a run file. The file gets
/// the status of the result, or "failed" and the message if an error ends the run. A scene of many beads
/// is better moved here: its beads are freed as soon as the jet has them.
///
/// errors : InputError before the first step if the scene cannot be built, the file cannot be
///          created or the run cannot be continued or resumed;
///          RunError if the run fails. Its message has the path of the file and says how much of the run
///          it contains: everything up to then, unless the disk is full or the file was removed
RunResult run_scene(Scene scene, const std::filesystem::path& file,
                    RunOptions options = {});

} // namespace ehdjet
