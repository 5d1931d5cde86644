#include "ehdjet/runs/run_scene.hpp"

#include "ehdjet/budget/budget.hpp"
#include "ehdjet/budget/effective_tension.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/core/version.hpp"
#include "ehdjet/coulomb/simd_level.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace ehdjet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// The caller has stopped the run.
struct Interrupted
    : Error { // no RunError, which an attempt with a shorter step might follow
  using Error::Error;
};

void add_records(Simulation& simulation, const std::shared_ptr<RunFile>& file,
                 const Scene& scene) {
  const SceneConfig& config = scene.config;
  const OutputConfig& output = config.output;
  if (output.observables)
    simulation.add(record_observables(
        file, *output.observables,
        {.coulomb_error = config.coulomb && config.coulomb->check_every,
         .two_rates = simulation.statistics().two_rates.has_value(),
         .accounts = has_near_field(config)
                         ? std::make_shared<EffectiveTension>(simulation.dynamics())
                         : nullptr}));
  if (output.frames)
    simulation.add(record_frames(file, *output.frames, *simulation.jet().table));
  if (output.deposit) simulation.add(record_deposit(file, simulation.jet().table));
  if (output.refinements != RefinementRecords::none)
    simulation.add(
        record_refinements(file, output.refinements == RefinementRecords::energies));
  if (output.resolving_power)
    simulation.add(
        record_resolving_power(file, *output.resolving_power, config.nozzle->link_length));
  if (output.budget) {
    const auto budget =
        std::make_shared<Budget>(simulation.dynamics(), simulation.events());
    simulation.add(record_budget(file, *output.budget, budget));
    simulation.add(budget);
  }
  simulation.add(record_checkpoints(file));
}

void add_records(ArraySimulation& simulation, const std::shared_ptr<RunFile>& file,
                 const Scene& scene) {
  const OutputConfig& output = scene.config.output;
  const auto& table = simulation.jet(0).table;
  if (output.observables)
    simulation.add(record_array_observables(file, *output.observables,
                                            scene.config.coulomb->check_every.has_value()));
  if (output.frames) simulation.add(record_array_frames(file, *output.frames, *table));
  if (output.deposit) simulation.add(record_array_deposit(file, table));
  if (output.refinements != RefinementRecords::none)
    simulation.add(record_array_refinements(file));
  simulation.add(record_array_checkpoints(file));
}

double time_of(const Simulation& s) {
  return s.jet().time;
}
double time_of(const ArraySimulation& s) {
  return s.time();
}

/// Description of the solver, or an empty text for the direct sum.
std::string coulomb_method(const Simulation& s) {
  for (const auto& term : s.dynamics().terms())
    if (const auto report = term->report(); report && report->method != "direct")
      return report->method;
  return {};
}

std::string coulomb_method(const ArraySimulation& s) {
  const std::string text = s.dynamics().solver().description();
  return text == "direct" ? std::string() : text;
}

RunResult end_of(const Simulation& s, const Scene& scene, bool failed) {
  RunResult result{.file = {},
                   .status = {},
                   .message = {},
                   .jet = s.jet(),
                   .statistics = s.statistics(),
                   .ledger = s.ledger(),
                   .coulomb_method = coulomb_method(s)};
  if (has_near_field(scene.config) && !failed)
    result.tension = EffectiveTension(s.dynamics()).of(s.jet());
  result.statistics.coincident_pairs = s.dynamics().coincident_pairs();
  return result;
}

RunResult end_of(const ArraySimulation& s, const Scene& /*scene*/, bool /*failed*/) {
  RunResult result{.file = {},
                   .status = {},
                   .message = {},
                   .jet = {},
                   .statistics = s.statistics(),
                   .ledger = sum_of(s.ledgers()),
                   .coulomb_method = coulomb_method(s)};
  for (std::size_t j = 0; j < s.jets(); ++j) result.array.push_back(s.jet_in_array(j));
  return result;
}

/// What differs between the program that wrote a file and this one, on which the bits depend.
void note_other_bits(const RunReader& before, const RunOptions& options) {
  if (!options.note) return;
  const auto now = build_environment();
  for (const char* name : {"version", "commit", "simd"})
    if (const std::string was = before.attribute(name); was != now.at(name))
      options.note(
          fmt::format("{} was made with {} {} and is continued with {}: from here on "
                      "its last digits may be others than those of a run in one go",
                      before.path().string(), name, was, now.at(name)));
  if (const std::string threads = before.attribute("threads"); threads != now.at("threads"))
    options.note(
        fmt::format("{} is a run on {} thread(s) and is continued on {}: from here on "
                    "its last digits are others than those of a run in one go",
                    before.path().string(), threads, now.at("threads")));
}

/// What `read` returns; whatever it finds wrong in what a run file says is an error of that file.
template <class Read>
auto naming(const fs::path& file, const Read& read) {
  try {
    return read();
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} cannot be continued: {}", file.string(), e.what()));
  }
}

template <class S>
void restore(S& simulation, const Checkpoint& checkpoint, const fs::path& file,
             const Scene& scene) {
  naming(file, [&] { simulation.restore(checkpoint); });
  if (const double t = time_of(simulation); t >= scene.config.run.end_time)
    throw InputError(
        fmt::format("{} cannot be continued: its checkpoint at t = {:.9g} s is "
                    "not before run.end_time = {} s",
                    file.string(), t, scene.config.run.end_time));
}

/// Restores the last checkpoint of another run of the same scene.
template <class S>
void go_on_from(const fs::path& file, const fs::path& output, S& simulation,
                const Scene& scene, const RunOptions& options) {
  std::error_code ignored;
  if (fs::equivalent(file, output, ignored))
    throw InputError(
        fmt::format("{} contains the run up to its checkpoint: choose another name "
                    "for its continuation with -o, or go on in the same file with --resume",
                    file.string()));
  const RunReader before(file);
  const std::string resolved = before.scene("resolved");
  if (const auto d = naming(file, [&] { return difference_from(resolved, scene.config); }))
    throw InputError(fmt::format("{} cannot be continued with this scene: {}. Only "
                                 "run.end_time, run.max_wall_time and [output] may differ",
                                 file.string(), *d));
  note_other_bits(before, options);
  restore(simulation, before.checkpoint(), file, scene);
}

/// What a run that is to be resumed has to do.
struct Resumption {
  enum class Task { start, start_again, go_on, nothing } task = Task::start;
  std::optional<StoppedRun> stopped = {};
  std::map<std::string, std::string> history = {}; // attributes of the file
};

constexpr const char *continued_from = "continued_from", *continued_at = "continued_at",
                     *resumed_at = "resumed_at";

/// The time of the last results [s].
double last_row(const RunReader& run) {
  double last = 0;
  if (run.has("frames"))
    for (const double t : run.frame_times()) last = std::max(last, t);
  if (run.has("observables"))
    for (const double t : run.column("observables", "time")) last = std::max(last, t);
  return last;
}

Resumption resumption_of(const fs::path& path, const Scene& scene,
                         const RunOptions& options) {
  using Task = Resumption::Task;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  const RunReader before(path);
  const std::string resolved = before.scene("resolved");
  if (const auto differences =
          naming(path, [&] { return differences_in_file(resolved, scene.config); });
      !differences.empty())
    throw InputError(fmt::format(
        "{} holds a run of another scene: {}. Only run.end_time, run.max_wall_time, "
        "output.flush and the times of checkpoints may differ. Choose another file with -o",
        path.string(), fmt::join(differences, "; ")));
  const bool complete = before.attribute("status") == "complete";
  const double end = config_of(resolved).run.end_time;
  if (complete && end == scene.config.run.end_time) return {.task = Task::nothing};
  if (const double reached = complete ? end : last_row(before);
      reached > scene.config.run.end_time)
    throw InputError(fmt::format("{} has results up to {} s, and run.end_time = {} s would "
                                 "cut them off: overwrite it "
                                 "with --force, or choose another file with -o",
                                 path.string(), reached, scene.config.run.end_time));
  const std::optional<Checkpoint> checkpoint = before.last_checkpoint();
  if (!checkpoint && complete)
    throw InputError(fmt::format(
        "{} is complete up to {} s and has no checkpoint from which it could go on to "
        "run.end_time = {} s: overwrite it with --force, or choose another file with -o",
        path.string(), end, scene.config.run.end_time));
  note_other_bits(before, options);
  Resumption found{.task = checkpoint ? Task::go_on : Task::start_again};
  for (const char* name : {continued_from, continued_at, resumed_at})
    if (before.has_attribute(name)) found.history[name] = before.attribute(name);
  if (checkpoint)
    found.stopped = StoppedRun{.file = path, .checkpoint = *checkpoint};
  else if (found.history.contains(continued_from))
    throw InputError(
        fmt::format("{} has no checkpoint from which it could go on, and it does not "
                    "begin at t = 0: continue {} again, with --force",
                    path.string(), found.history[continued_from]));
  return found;
}

/// Creates the run file, or goes on with that of a stopped run from its checkpoint.
template <class S>
std::shared_ptr<RunFile> open_file(S& simulation, const Scene& scene, const fs::path& path,
                                   const RunOptions& options, const Resumption& resumption,
                                   Provenance provenance) {
  const double flush = scene.config.output.flush;
  if (const auto& stopped = resumption.stopped) {
    restore(simulation, stopped->checkpoint, path, scene);
    for (const auto& [name, text] : resumption.history) provenance.environment[name] = text;
    std::string& times = provenance.environment[resumed_at];
    times += fmt::format("{}{} s", times.empty() ? "" : ", ", time_of(simulation));
    return std::make_shared<RunFile>(*stopped, provenance, flush);
  }
  if (options.continue_from) {
    go_on_from(*options.continue_from, path, simulation, scene, options);
    provenance.environment[continued_from] = options.continue_from->string();
    provenance.environment[continued_at] = fmt::format("{} s", time_of(simulation));
  }
  const bool again = resumption.task == Resumption::Task::start_again;
  return std::make_shared<RunFile>(path, options.overwrite || again, provenance, flush);
}

/// Decides after each step whether the run makes a checkpoint and whether it stops, because the caller wants it
/// or its time on the clock is over. When it stops, the checkpoint comes first.
class Watch {
public:
  Watch(const RunOptions& options, const SceneConfig& config)
      : options_(options)
      , limit_(config.run.max_wall_time)
      , interval_(config.output.checkpoint_wall_time) {}

  [[nodiscard]] bool wants_checkpoint() {
    look();
    const bool asked = options_.checkpoint_wanted && options_.checkpoint_wanted();
    const bool due = interval_ > 0 && seconds_since(checkpoint_) >= interval_;
    if (!due && !asked && reason_.empty()) return false;
    checkpoint_ = Clock::now();
    return true;
  }
  /// At the end of a step. A reason to stop that comes up between a decision on a checkpoint and this call waits
  /// for the next step.
  /// errors : Interrupted
  void after_step(double t) {
    if (!std::exchange(looked_, false)) look();
    stop(t);
  }
  /// Before a step is attempted again, which may happen many times.
  void between_attempts(double t) {
    look();
    looked_ = false;
    stop(t);
  }

private:
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  void look() {
    looked_ = true;
    if (!reason_.empty()) return;
    if (const char* signal = options_.interrupted ? options_.interrupted() : nullptr)
      reason_ = signal;
    else if (limit_ && seconds_since(start_) >= *limit_)
      reason_ = fmt::format("run.max_wall_time = {} s", *limit_);
  }
  void stop(double t) const {
    if (!reason_.empty())
      throw Interrupted(fmt::format("stopped by {} at t = {:.9g} s", reason_, t));
  }

  const RunOptions& options_;
  std::optional<double> limit_; // [s]
  double interval_;             // between checkpoints [s]
  Clock::time_point start_ = Clock::now(), checkpoint_ = start_;
  std::string reason_;
  bool looked_ = false; // in this step
};

/// Added last, so that the other observers see the last step.
template <class S>
void add_watch(S& simulation, Watch& watch, const Scene& scene) {
  if (const auto interval = scene.config.output.checkpoints)
    simulation.make_checkpoints(*interval);
  simulation.make_checkpoints_when([&] { return watch.wants_checkpoint(); });
  simulation.after_each_step([&](const S& s) { watch.after_step(time_of(s)); });
  simulation.between_attempts([&] { watch.between_attempts(time_of(simulation)); });
}

/// `S`: Simulation or ArraySimulation.
template <class S>
RunResult run_into_file(S& simulation, const Scene& scene, const fs::path& path,
                        const RunOptions& options, const Resumption& resumption,
                        const std::function<void(S&)>& started) {
  Provenance provenance{.scene_file = options.scene_file,
                        .scene_given = scene.given,
                        .scene_resolved = resolved_toml(scene.config),
                        .environment = ehdjet::build_environment()};
  for (const auto& [name, text] : options.provenance)
    provenance.environment.emplace(name, text);
  const auto file =
      open_file(simulation, scene, path, options, resumption, std::move(provenance));
  if (resumption.stopped) { // if this fails, the file is still the old one
    add_records(simulation, file, scene);
    file->take_place();
  }
  Watch watch(options, scene.config);
  std::shared_ptr<DryFibre> fibre;
  const auto finish = [&](const char* status, const std::string& message) {
    RunResult result = end_of(simulation, scene, std::string_view(status) == "failed");
    result.status = status, result.message = message;
    result.threads = static_cast<std::size_t>(omp_get_max_threads()); // see ThreadCount
    if (fibre) result.fibre = fibre->summary();
    std::map<std::string, std::string> notes;
    if (!result.coulomb_method.empty()) notes["coulomb"] = result.coulomb_method;
    file->finish(status, message, result.statistics, result.ledger, notes);
    result.file = file->path();
    return result;
  };
  try {
    if (!resumption.stopped) add_records(simulation, file, scene);
    if constexpr (std::is_same_v<S, Simulation>)
      if (const auto& table = simulation.jet().table; table->drying()) {
        fibre = std::make_shared<DryFibre>(
            table, std::max(scene.config.run.end_time / 2, time_of(simulation)));
        simulation.add(fibre);
      }
    if (started) started(simulation);
    add_watch(simulation, watch, scene);
    simulation.run_until(scene.config.run.end_time);
  } catch (const Interrupted& e) {
    return finish("interrupted", e.what());
  } catch (const Error& e) {
    try {
      finish("failed", e.what());
    } catch (const RunError&) { // the disk is full, and that much is said about the file
    }
    throw Error(fmt::format("{}; {}", e.what(), file->contents()), e.exit_code());
  } catch (const std::exception& e) { // from the caller's force term, event or observer
    finish("failed", e.what());
    throw;
  }
  return finish("complete", "");
}

} // namespace

std::map<std::string, std::string> build_environment() {
  return {{"version", version::number},
          {"commit", version::commit},
          {"compiler", version::compiler},
          {"build_type", version::build_type},
          {"simd", std::string(name_of(best_simd_level()))},
          {"threads", std::to_string(granted_threads(
                          static_cast<std::size_t>(omp_get_max_threads())))}};
}

RunResult run_scene(Scene scene, const fs::path& path, RunOptions options) {
  const ThreadCount threads(options.threads ? options.threads : scene.config.run.threads);
  EHDJET_EXPECTS(!options.resume || !options.continue_from);
  Resumption resumption;
  if (options.resume) resumption = resumption_of(path, scene, options);
  if (resumption.task == Resumption::Task::nothing) {
    RunResult complete;
    complete.file = path, complete.status = "complete", complete.was_complete = true;
    return complete;
  }
  if (scene.config.array) {
    if (const Extras& e = options.extras;
        !e.forces.empty() || !e.events.empty() || !e.observers.empty())
      throw InputError(
          "[array] cannot be used with force terms, events or observers that a "
          "program adds: they are those of a single jet");
    const auto simulation = build_array_simulation(scene);
    return run_into_file(*simulation, scene, path, options, resumption,
                         options.array_started);
  }
  const auto simulation = build_simulation(scene, std::move(options.extras));
  scene.chain = {};
  return run_into_file(*simulation, scene, path, options, resumption, options.started);
}

} // namespace ehdjet
