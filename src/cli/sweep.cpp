#include "ehdjet/sweeps/sweep.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "commands.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

struct Options {
  std::string plan, output;
  bool force = false;
};

void sweep(const Options& options) {
  const std::filesystem::path folder = options.output.empty()
                                           ? std::filesystem::path(options.plan).stem()
                                           : std::filesystem::path(options.output);
  const Sweep sweep = read_sweep(options.plan, folder);
  const SweepFiles files = write_sweep(sweep, folder, options.force);
  for (const std::string& file : files.dropped)
    message("{} is of a former plan; it and its run stay\n", (folder / file).string());
  if (files.written == 0)
    print_result("{} runs, nothing to do: {} is up to date\n", sweep.runs.size(),
                 folder.string());
  else
    print_result("{} runs, {} scene files written; list of runs: {}\n", sweep.runs.size(),
                 files.written, (folder / "index.csv").string());
}

} // namespace

void add_sweep_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Write a scene file for every combination of the values in a plan");
  command->add_option("PLAN", options->plan, "Plan (TOML): docs/sweeps.md")->required();
  command
      ->add_option("-o,--output", options->output,
                   "Folder of the scene files and index.csv; default: the plan's name "
                   "without extension, in this folder")
      ->type_name("FOLDER");
  command->add_flag("--force", options->force,
                    "Overwrite scene files of another plan. Runs are never touched");
  command->callback([options] { sweep(*options); });
}

} // namespace ehdjet::cli
