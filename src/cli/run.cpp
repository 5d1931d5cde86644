#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/scene/scene_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "cost_watch.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "scenes.hpp"
#include "standard_streams.hpp"
#include "version.hpp"

namespace ehdjet::cli {
namespace {

struct Options {
  SceneOptions scene;
  std::string output, continued;
  std::optional<std::size_t> threads;
  bool quiet = false, force = false, resume = false;
};

double time_of(const Simulation& s) {
  return s.jet().time;
}
double time_of(const ArraySimulation& s) {
  return s.time();
}

std::size_t beads_of(const Simulation& s) {
  return s.jet().beads();
}
std::size_t beads_of(const ArraySimulation& s) {
  return s.beads();
}

/// Prints a message when a check finds an error of the Coulomb force above the tolerance.
template <class S>
void report_violations(S& simulation, double tolerance) {
  auto reported = simulation.statistics().coulomb_violations;
  simulation.after_each_step([=](const S& s) mutable {
    const RunStatistics& statistics = s.statistics();
    if (statistics.coulomb_violations == reported) return;
    reported = statistics.coulomb_violations;
    message("\nat t = {:.9g} s the error of the Coulomb force was {:.2g}, more than the "
            "tolerance {:g}; the solver is stricter from now on\n",
            time_of(s), *statistics.coulomb_error, tolerance);
  });
}

/// Where a jet has got to.
struct Reach {
  explicit Reach(const JetState& jet)
      : tip(jet.columns().position()[jet.links()])
      , off_axis(std::hypot(tip.y(), tip.z())) {
    const auto r = jet.columns().position();
    for (std::size_t k = 1; k < jet.beads(); ++k) path += (r[k] - r[k - 1]).norm();
  }
  Vec3 tip;
  double off_axis, path = 0; // [m]
};

std::string reach_text(const JetState& jet) {
  const Reach reach(jet);
  return fmt::format("  beads         {}\n"
                     "  tip           x = {:.6g} cm, {:.6g} cm off the axis\n"
                     "  path length   {:.6g} cm\n",
                     jet.beads(), 100 * reach.tip.x(), 100 * reach.off_axis,
                     100 * reach.path);
}

std::string reach_text(const std::vector<JetState>& jets) {
  std::size_t beads = 0;
  std::vector<double> off_axis, path;
  for (const JetState& jet : jets) {
    const Reach reach(jet);
    beads += jet.beads();
    off_axis.push_back(100 * reach.off_axis), path.push_back(100 * reach.path);
  }
  const auto [nearest, farthest] = std::ranges::minmax(off_axis);
  const auto [shortest, longest] = std::ranges::minmax(path);
  return fmt::format("  jets          {}\n"
                     "  beads         {} of all jets\n"
                     "  tips          {:.6g} to {:.6g} cm off the axis of the array\n"
                     "  path lengths  {:.6g} to {:.6g} cm\n",
                     jets.size(), beads, nearest, farthest, shortest, longest);
}

std::string summary(const RunResult& result, const SceneConfig& scene,
                    const std::filesystem::path& file) {
  const double time = scene.array ? result.array.front().time : result.jet.time;
  const RunStatistics& cost = result.statistics;
  std::string text = fmt::format("  time          {:.6g} s\n", time)
                     + (scene.array ? reach_text(result.array) : reach_text(result.jet));
  if (cost.landings > 0)
    text += fmt::format(
        "  collector     last bead landed with radius {:.5g} um at {:.6g} m/s\n",
        1e6 * result.ledger.collector_radius, result.ledger.impact_speed);
  if (scene.nozzle || scene.collector)
    text += fmt::format("  events        {} insertions, {} releases, {} landings\n",
                        cost.insertions, cost.releases, cost.landings);
  if (cost.refinements)
    text += fmt::format("  refinements   {} that changed the mesh\n", *cost.refinements);
  if (scene.nozzle && time > 0) {
    const double flow = result.ledger.inserted_volume / time;
    text += fmt::format(
        "  inflow        {:.4g} m^3/s ({:.4g} mL/h), {:.4g} A, means since t = 0\n", flow,
        3.6e9 * flow, result.ledger.inserted_charge / time);
  }
  if (result.tension)
    text +=
        fmt::format("  tension       negative in {:.3g} % of the links, smallest {:.3g} N; "
                    "shortest link {:.3g} radii\n",
                    100 * result.tension->unstable_links, result.tension->smallest,
                    result.tension->shortest_in_radii);
  if (!result.coulomb_method.empty())
    text += fmt::format("  Coulomb       {}\n", result.coulomb_method);
  if (cost.method)
    text += fmt::format("  integrator    {}: {} since t = {:.4g} s, {} changes\n",
                        scene.integrator.method, cost.method->in_use, cost.method->since,
                        cost.method->changes);
  if (cost.two_rates && cost.two_rates->steps > 0)
    text += fmt::format(
        "  two rates     {} macro steps ({}) with {} evaluations of the {} beads at the "
        "nozzle; {:.4g} Coulomb sums in all\n",
        cost.two_rates->steps, cost.two_rates->method, cost.two_rates->inner_evaluations,
        cost.two_rates->inner_beads, cost.two_rates->full_sums);
  text +=
      fmt::format("  cost          {} evaluations, {} steps, {} rejected, {:.2f} s on {} "
                  "thread{}\n",
                  cost.evaluations, cost.steps, cost.rejected, cost.wall_time,
                  result.threads, result.threads == 1 ? "" : "s");
  if (cost.coincident_pairs > 0)
    text += fmt::format("  warning       {} of beads at zero distance skipped, the most in "
                        "one evaluation\n",
                        cost.coincident_pairs == 1
                            ? "1 pair"
                            : fmt::format("{} pairs", cost.coincident_pairs));
  if (result.fibre)
    text += fmt::format("  fibre         {:.4g} m landed at {:.3g} m/s since t = {:.4g} s, "
                        "{:.3g} % of its volume "
                        "evaporated\n  dry diameter  {:.4g} um, scatter {:.2g} um\n",
                        result.fibre->length, result.fibre->speed, result.fibre->since,
                        100 * result.fibre->evaporated, 1e6 * result.fibre->diameter,
                        1e6 * result.fibre->scatter);
  return text + fmt::format("  written to    {}\n", file.string());
}

/// The files that a scene is read from. Their paths in a scene are relative to it.
std::vector<std::filesystem::path> inputs_of(const std::filesystem::path& scene,
                                             const SceneConfig& c) {
  const std::filesystem::path folder = scene.parent_path();
  std::vector<std::filesystem::path> inputs{scene};
  if (c.chain) inputs.push_back(folder / c.chain->file);
  if (c.coulomb && c.coulomb->calibration)
    inputs.push_back(folder / *c.coulomb->calibration);
  if (c.air && c.air->profile) inputs.push_back(folder / *c.air->profile);
  return inputs;
}

void run(const Options& options) {
  Scene scene = options.scene.read();
  const SceneConfig config = scene.config;
  const std::vector<std::string> warnings = run_warnings(scene);
  const std::filesystem::path path =
      options.output.empty()
          ? std::filesystem::path(options.scene.scene).filename().replace_extension(".h5")
          : std::filesystem::path(options.output);
  const std::filesystem::path source = find_scene(options.scene.scene);
  const std::string origin = origin_of(source);
  if (!options.resume) { // which keeps what is there
    refuse_input(path, source);
    for (const auto& input : inputs_of(origin, config)) refuse_input(path, input);
  }
  std::optional<Progress> progress;
  std::optional<InterruptGuard> interrupt;
  RunOptions run;
  run.overwrite = options.force, run.threads = options.threads;
  run.scene_file = origin, run.provenance = environment();
  run.interrupted = InterruptGuard::signal_name;
  if (!options.quiet)
    run.note = [](const std::string& text) { message("ehdjet: {}\n", text); };
  run.checkpoint_wanted = InterruptGuard::checkpoint_wanted;
  run.resume = options.resume;
  if (!options.continued.empty()) run.continue_from = options.continued;
  const auto started = [&](auto& simulation) {
    interrupt.emplace();
    if (options.quiet) return;
    const SceneConfig& c = config;
    for (const std::string& warning : warnings) message("warning: {}\n", warning);
    const double start = time_of(simulation), end = c.run.end_time;
    const std::string from = start > 0 ? fmt::format(" from t = {:.6g} s on", start) : "";
    message("{}{}simulating {:.6g} s{} into {}\n", c.title, c.title.empty() ? "" : "\n",
            end - start, from, path.string());
    if (c.coulomb && c.coulomb->check_every)
      report_violations(simulation, c.coulomb->tolerance);
    progress.emplace(start, end);
    simulation.after_each_step(
        [&, watch = CostWatch(start, end, beads_of(simulation), simulation.statistics())](
            const auto& s) mutable {
          progress->show(s);
          if (const auto warning = watch.look(progress->wall_time(), time_of(s),
                                              beads_of(s), s.statistics())) {
            progress->clear();
            message("warning: {}\n", *warning);
          }
        });
  };
  run.started = started, run.array_started = started;
  if (!options.quiet)
    warn_of_threads(options.threads ? options.threads : config.run.threads);
  const RunResult result = run_scene(std::move(scene), path, std::move(run));
  progress.reset();
  if (result.was_complete) {
    if (!options.quiet)
      print_result("{} is complete up to t = {} s; nothing is left to do\n", path.string(),
                   config.run.end_time);
    return;
  }
  std::error_code ignored;
  const bool renamed = !std::filesystem::equivalent(path, result.file, ignored);
  const std::filesystem::path& written = renamed ? result.file : path;
  if (result.status == "interrupted")
    throw RunError(
        fmt::format("{}; everything up to then is in {}. Go on with ehdjet run --resume",
                    result.message, written.string()));
  if (renamed && !options.quiet)
    message("warning: {} was renamed during the run, to {}\n", path.string(),
            written.string());
  if (!options.quiet) print_result("{}", summary(result, config, written));
}

} // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("run", "Simulate a scene and write a run file (HDF5)");
  options->scene.add_to(*command)->required();
  command->add_option("-o,--output", options->output,
                      "Run file; default: the scene's name with .h5, in this folder");
  command
      ->add_option(
          "--continue", options->continued,
          "Continue from the last checkpoint (output.checkpoints) of a run of this "
          "scene. Only run.end_time, run.max_wall_time and [output] may differ")
      ->type_name("FILE.h5");
  add_threads_option(*command, options->threads);
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  CLI::Option* force =
      command->add_flag("--force", options->force, "Overwrite the run file if it exists");
  command
      ->add_flag(
          "--resume", options->resume,
          "Go on with the run in the run file, from its last checkpoint; start if there "
          "is no file, do nothing if it is complete")
      ->excludes(force)
      ->excludes(command->get_option("--continue"));
  command->callback([options] { run(*options); });
}

} // namespace ehdjet::cli
