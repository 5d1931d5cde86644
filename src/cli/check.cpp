#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/simulation/build.hpp"
#include "ehdjet/studies/cost_probe.hpp"

#include <cstddef>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

std::string duration(double seconds) {
  if (seconds < 120) return fmt::format("{:.2g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.2g} min", seconds / 60);
  return fmt::format("{:.2g} h", seconds / 3600);
}

std::string text_of(const CostEstimate& cost) {
  if (cost.complete)
    return fmt::format(
        "\nCost, measured: the run came to its end\n"
        "  beads         {:.0f}\n  evaluations   {:.0f}\n  wall time     {:.2g} s\n",
        cost.beads, cost.evaluations, cost.wall_time);
  std::string text = fmt::format(
      "\nCost, from the first {:.3g} s, which took {:.2g} s; within a factor of 2 if beads "
      "have "
      "landed by then, and 5 if not\n"
      "  landed        {}\n  beads         about {:.2g}, the largest number\n"
      "  evaluations   about {:.2g}\n  wall time     about {}{}\n",
      cost.start, cost.spent, cost.landed ? "yes" : "no: a longer probe says more",
      cost.beads, cost.evaluations, duration(cost.wall_time),
      cost.two_rates_later
          ? " with one rate; two rates, which it may take from 200 beads on, take "
            "less, the more the longer the jet is"
          : "");
  if (cost.frames > 0)
    text += fmt::format("  run file      up to {:.2g} MB of frames; packing saves some\n",
                        1e-6 * cost.frames);
  return text;
}

} // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Validate a scene and say what would be simulated, without running it");
  CLI::Option* scene = options->add_to(*command);
  auto seconds = std::make_shared<double>(0);
  auto threads = std::make_shared<std::optional<std::size_t>>();
  command
      ->add_option(
          "--probe", *seconds,
          "Also simulate the start of the run for that long [s of wall time], without "
          "writing anything, and estimate from it what the run will cost")
      ->check(CLI::Range(0.01, 1e6))
      ->type_name("SECONDS");
  add_threads_option(*command, *threads);
  command->get_option("--threads")->needs("--probe");
  CLI::Option* keys =
      command->add_flag("--keys")
          ->description("Print the reference of all tables and keys (Markdown)")
          ->excludes(scene)
          ->excludes("--probe");
  command->callback([options, scene, keys, seconds, threads] {
    if (!keys->empty()) {
      print_result("{}", key_reference());
      return;
    }
    if (scene->empty()) throw CLI::RequiredError("SCENE");
    const Scene read = options->read();
    // Finds errors that only appear when the objects are built.
    if (read.config.array)
      build_array_simulation(read);
    else
      build_simulation(read);
    print_result("{}", scene_report(read));
    if (*seconds > 0) print_result("{}", text_of(probe_cost(read, *seconds, *threads)));
  });
}

} // namespace ehdjet::cli
