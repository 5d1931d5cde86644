#include "run.hpp"

#include "ehdjet/budget/budget.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/io/run_file.hpp"
#include "ehdjet/io/run_reader.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "calibrate.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "threads.hpp"
#include "version.hpp"

namespace ehdjet::cli {
namespace {

struct RunOptions {
  std::string scene, output, calibration, continued;
  std::vector<std::string> overrides;
  std::optional<std::size_t> threads;
  bool quiet = false, force = false;
};

/// The run was stopped from outside.
struct Interrupted : RunError {
  using RunError::RunError;
};

void add_observers(Simulation& simulation, RunFile& file, const Scene& scene) {
  const SceneConfig& config = scene.config;
  if (config.output.observables)
    simulation.add(file.observables(*config.output.observables,
                                    config.coulomb && config.coulomb->check_every));
  if (config.output.frames)
    simulation.add(file.frames(*config.output.frames, simulation.dynamics().has_stress()));
  if (config.output.deposit) simulation.add(file.deposit());
  if (config.output.refinements != RefinementRecords::none)
    simulation.add(
        file.refinements(config.output.refinements == RefinementRecords::energies));
  if (config.output.resolving_power)
    simulation.add(
        file.resolving_power(*config.output.resolving_power, config.nozzle->link_length));
  if (config.output.budget) {
    auto budget = std::make_unique<Budget>(simulation.dynamics(), simulation.events());
    simulation.add(file.budget(*config.output.budget, *budget));
    simulation.add(std::move(budget));
  }
}

/// What the solver has done, unless it is the direct sum, of which there is nothing to tell.
std::string coulomb_method(const Simulation& s) {
  for (const auto& term : s.dynamics().terms())
    if (const auto report = term->report(); report && report->method != "direct")
      return report->method;
  return {};
}

/// Says so when a check of the Coulomb force finds more than the tolerance.
class ViolationLog {
public:
  ViolationLog(double tolerance, const Simulation& s)
      : tolerance_(tolerance)
      , logged_(s.statistics().coulomb_violations) {}
  void look(const Simulation& s) {
    const RunStatistics& statistics = s.statistics();
    if (statistics.coulomb_violations == logged_) return;
    logged_ = statistics.coulomb_violations;
    fmt::print(
        stderr,
        "\nat t = {:.9g} s the Coulomb force was off by {:.2g}, more than the tolerance "
        "{:g}; the solver is stricter from here on\n",
        s.jet().time, *statistics.coulomb_error, tolerance_);
  }

private:
  double tolerance_;
  std::uint64_t logged_;
};

std::string summary(const Simulation& s, const Scene& scene,
                    const std::filesystem::path& file) {
  const JetState& jet = s.jet();
  const auto r = jet.columns().position();
  const Vec3 tip = r[jet.links()];
  double path = 0;
  for (std::size_t k = 1; k < jet.beads(); ++k) path += (r[k] - r[k - 1]).norm();
  const RunStatistics& cost = s.statistics();
  std::string text = fmt::format("  time          {:.6g} s\n"
                                 "  beads         {}\n"
                                 "  tip           x = {:.6g} cm, {:.6g} cm off the axis\n"
                                 "  path length   {:.6g} cm\n",
                                 jet.time, jet.links(), 100 * tip.x(),
                                 100 * std::hypot(tip.y(), tip.z()), 100 * path);
  if (cost.landings > 0)
    text += fmt::format(
        "  collector     last bead landed with radius {:.5g} um at {:.6g} m/s\n",
        1e6 * s.ledger().collector_radius, s.ledger().impact_speed);
  if (scene.config.nozzle || scene.config.collector)
    text += fmt::format("  events        {} insertions, {} releases, {} landings\n",
                        cost.insertions, cost.releases, cost.landings);
  if (cost.refinements)
    text += fmt::format("  refinements   {} that changed the mesh\n", *cost.refinements);
  if (const std::string method = coulomb_method(s); !method.empty())
    text += fmt::format("  Coulomb       {}\n", method);
  if (cost.method)
    text += fmt::format("  integrator    auto: {} since t = {:.4g} s, {} changes\n",
                        cost.method->in_use, cost.method->since, cost.method->changes);
  text += fmt::format("  cost          {} evaluations, {} steps, {} rejected, {:.2f} s\n",
                      cost.evaluations, cost.steps, cost.rejected, cost.wall_time);
  if (s.dynamics().coincident_pairs() > 0)
    text += fmt::format("  warning       {} pairs of beads at zero distance were skipped\n",
                        s.dynamics().coincident_pairs());
  return text + fmt::format("  written to    {}\n", file.string());
}

/// Takes over the jet of a run of the same scene that another file has a checkpoint of.
void go_on_from(const std::string& file, Simulation& simulation, const Scene& scene) {
  const RunReader before(file);
  if (const auto d = difference_from(before.scene_resolved(), scene.config))
    throw InputError(fmt::format("{} cannot be continued with this scene: {}. Only "
                                 "run.end_time and [output] may differ",
                                 file, *d));
  simulation.restore(before.checkpoint());
  if (const double t = simulation.jet().time; t >= scene.config.run.end_time)
    throw InputError(
        fmt::format("{} cannot be continued: its checkpoint at t = {:.9g} s is "
                    "not before run.end_time = {} s",
                    file, t, scene.config.run.end_time));
}

void refuse_overwriting(const std::filesystem::path& continued,
                        const std::filesystem::path& output) {
  std::error_code ignored;
  if (std::filesystem::equivalent(continued, output, ignored))
    throw InputError(
        fmt::format("{} holds the run up to its checkpoint: choose another name "
                    "for its continuation with -o",
                    continued.string()));
}

std::map<std::string, std::string> environment_of(const Simulation& simulation,
                                                  const std::string& continued) {
  auto environment = cli::environment();
  if (continued.empty()) return environment;
  environment["continued_from"] = continued;
  environment["continued_at"] = fmt::format("{} s", simulation.jet().time);
  return environment;
}

void run(const RunOptions& options) {
  const Scene scene =
      read_scene(options.scene, with_calibration(options.overrides, options.calibration));
  use_threads(options.threads ? options.threads : scene.config.run.threads);
  const auto simulation = build_simulation(scene);

  const std::filesystem::path path =
      options.output.empty()
          ? std::filesystem::path(options.scene).filename().replace_extension(".h5")
          : std::filesystem::path(options.output);
  if (!options.continued.empty()) {
    refuse_overwriting(options.continued, path);
    go_on_from(options.continued, *simulation, scene);
  }
  RunFile file(path, options.force,
               {.scene_file = options.scene,
                .scene_given = scene.given,
                .scene_resolved = resolved_toml(scene.config),
                .environment = environment_of(*simulation, options.continued)},
               scene.config.output.flush);
  add_observers(*simulation, file, scene);
  if (scene.config.output.checkpoints) {
    simulation->make_checkpoints(*scene.config.output.checkpoints);
    simulation->add(file.checkpoints());
  }

  const double start = simulation->jet().time, end = scene.config.run.end_time;
  if (!options.quiet)
    fmt::print(stderr, "{}{}simulating {:.6g} s into {}\n", scene.config.title,
               scene.config.title.empty() ? "" : "\n", end - start, path.string());
  std::optional<Progress> progress;
  if (!options.quiet) progress.emplace(start, end);
  const InterruptGuard interrupt;
  std::optional<ViolationLog> violations;
  if (const auto& c = scene.config.coulomb; c && c->check_every && !options.quiet)
    violations.emplace(c->tolerance, *simulation);
  simulation->after_each_step([&](const Simulation& s) {
    if (violations) violations->look(s);
    if (progress) progress->show(s);
    if (const char* signal = InterruptGuard::signal_name())
      throw Interrupted(fmt::format("stopped by {} at t = {:.9g} s", signal, s.jet().time));
  });

  const auto finish = [&](const char* status, const std::string& message) {
    if (progress) progress->finish();
    RunStatistics statistics = simulation->statistics();
    statistics.coincident_pairs = simulation->dynamics().coincident_pairs();
    if (const std::string method = coulomb_method(*simulation); !method.empty())
      file.note_coulomb(method);
    file.finish(status, message, statistics, simulation->ledger());
  };
  const auto end_badly = [&](const char* status, const Error& e) {
    std::string kept = fmt::format("everything up to then is in {}", path.string());
    try {
      finish(status, e.what());
    } catch (const Error& also) {
      kept = also.what();
    }
    throw Error(fmt::format("{}; {}", e.what(), kept), e.exit_code());
  };
  try {
    simulation->run_until(end);
  } catch (const Interrupted& e) {
    end_badly("interrupted", e);
  } catch (const Error& e) {
    end_badly("failed", e);
  }
  finish("complete", "");
  if (!options.quiet) fmt::print("{}", summary(*simulation, scene, path));
}

} // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Simulate a scene and write a run file (HDF5)");
  command->add_option("SCENE", options->scene, "Scene file (TOML)")->required();
  command->add_option("-o,--output", options->output,
                      "Run file; default: the scene's name with .h5, in this folder");
  command
      ->add_option("--set", options->overrides,
                   "Override a key: table.key=value (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--continue", options->continued,
                   "Go on from the last checkpoint (output.checkpoints) of a run of this "
                   "scene; with another run.end_time and [output], if you like")
      ->type_name("FILE.h5");
  add_threads_option(*command, options->threads);
  add_calibration_option(*command, options->calibration);
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->add_flag("--force", options->force, "Overwrite the run file if it exists");
  command->callback([options] { run(*options); });
}

} // namespace ehdjet::cli
