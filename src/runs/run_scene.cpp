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
#include <exception>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

/// The caller has stopped the run.
struct Interrupted : RunError {
  using RunError::RunError;
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
  if (output.checkpoints) {
    simulation.make_checkpoints(*output.checkpoints);
    simulation.add(record_checkpoints(file));
  }
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
  if (output.checkpoints) {
    simulation.make_checkpoints(*output.checkpoints);
    simulation.add(record_array_checkpoints(file));
  }
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
  RunResult result{.status = {},
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
  RunResult result{.status = {},
                   .message = {},
                   .jet = {},
                   .statistics = s.statistics(),
                   .ledger = sum_of(s.ledgers()),
                   .coulomb_method = coulomb_method(s)};
  for (std::size_t j = 0; j < s.jets(); ++j) result.array.push_back(s.jet_in_array(j));
  return result;
}

/// Restores the last checkpoint of another run of the same scene.
template <class S>
void go_on_from(const fs::path& file, const fs::path& output, S& simulation,
                const Scene& scene) {
  std::error_code ignored;
  if (fs::equivalent(file, output, ignored))
    throw InputError(
        fmt::format("{} contains the run up to its checkpoint: choose another name "
                    "for its continuation with -o",
                    file.string()));
  const RunReader before(file);
  if (const auto d = difference_from(before.scene("resolved"), scene.config))
    throw InputError(fmt::format("{} cannot be continued with this scene: {}. Only "
                                 "run.end_time and [output] may differ",
                                 file.string(), *d));
  simulation.restore(before.checkpoint());
  if (const double t = time_of(simulation); t >= scene.config.run.end_time)
    throw InputError(
        fmt::format("{} cannot be continued: its checkpoint at t = {:.9g} s is "
                    "not before run.end_time = {} s",
                    file.string(), t, scene.config.run.end_time));
}

/// `S`: Simulation or ArraySimulation.
template <class S>
RunResult run_into_file(S& simulation, const Scene& scene, const fs::path& path,
                        const RunOptions& options, const std::function<void(S&)>& started) {
  Provenance provenance{.scene_file = options.scene_file,
                        .scene_given = scene.given,
                        .scene_resolved = resolved_toml(scene.config),
                        .environment = ehdjet::build_environment()};
  for (const auto& [name, text] : options.provenance)
    provenance.environment.emplace(name, text);
  if (options.continue_from) {
    go_on_from(*options.continue_from, path, simulation, scene);
    provenance.environment["continued_from"] = options.continue_from->string();
    provenance.environment["continued_at"] = fmt::format("{} s", time_of(simulation));
  }
  const auto file = std::make_shared<RunFile>(path, options.overwrite, provenance,
                                              scene.config.output.flush);
  add_records(simulation, file, scene);
  std::shared_ptr<DryFibre> fibre;
  if constexpr (std::is_same_v<S, Simulation>)
    if (const auto& table = simulation.jet().table; table->drying()) {
      fibre = std::make_shared<DryFibre>(
          table, std::max(scene.config.run.end_time / 2, time_of(simulation)));
      simulation.add(fibre);
    }
  if (started) started(simulation);
  if (options.interrupted) // added last, so that the other observers see the last step
    simulation.after_each_step([&](const S& s) {
      if (const char* reason = options.interrupted())
        throw Interrupted(fmt::format("stopped by {} at t = {:.9g} s", reason, time_of(s)));
    });

  const auto finish = [&](const char* status, const std::string& message) {
    RunResult result = end_of(simulation, scene, std::string_view(status) == "failed");
    result.status = status, result.message = message;
    if (fibre) result.fibre = fibre->summary();
    std::map<std::string, std::string> notes;
    if (!result.coulomb_method.empty()) notes["coulomb"] = result.coulomb_method;
    file->finish(status, message, result.statistics, result.ledger, notes);
    return result;
  };
  try {
    simulation.run_until(scene.config.run.end_time);
  } catch (const Interrupted& e) {
    return finish("interrupted", e.what());
  } catch (const Error& e) {
    std::string kept = fmt::format("everything up to then is in {}", path.string());
    try {
      finish("failed", e.what());
    } catch (const Error& also) {
      kept = also.what();
    }
    throw Error(fmt::format("{}; {}", e.what(), kept), e.exit_code());
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
          {"threads", std::to_string(omp_get_max_threads())}};
}

RunResult run_scene(Scene scene, const fs::path& path, RunOptions options) {
  const ThreadCount threads(options.threads ? options.threads : scene.config.run.threads);
  if (scene.config.array) {
    if (const Extras& e = options.extras;
        !e.forces.empty() || !e.events.empty() || !e.observers.empty())
      throw InputError(
          "[array] cannot be used with force terms, events or observers that a "
          "program adds: they are those of a single jet");
    const auto simulation = build_array_simulation(scene);
    return run_into_file(*simulation, scene, path, options, options.array_started);
  }
  const auto simulation = build_simulation(scene, std::move(options.extras));
  scene.chain = {};
  return run_into_file(*simulation, scene, path, options, options.started);
}

} // namespace ehdjet
