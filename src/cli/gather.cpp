#include "ehdjet/sweeps/gather.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

struct Options {
  std::vector<std::string> runs;
  std::string output;
  MeanWindow window;
  bool json = false, force = false;
};

void gather(const Options& options) {
  if (const auto& [from, to] = options.window; from && to && *from > *to)
    throw InputError(
        fmt::format("--from {} s is after --to {} s: no run has a mean", *from, *to));
  if (!options.output.empty())
    for (const std::string& run : options.runs) refuse_input(options.output, run);
  TextOutput output =
      options.output.empty() ? TextOutput() : TextOutput(options.output, options.force);
  const GatheredRuns table =
      gather_runs({options.runs.begin(), options.runs.end()}, options.window);
  if (options.json)
    table.print_json(output);
  else
    table.print_csv(output);
  if (options.output.empty()) return;
  const auto complete = std::ranges::count_if(
      table.rows, [](const auto& row) { return row[1] == GatheredRuns::Cell("complete"); });
  print_result("{} runs, {} of them complete; written to {}\n", table.rows.size(), complete,
               options.output);
}

} // namespace

void add_gather_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "gather", "One table of many runs: what differs, status, stationary means, cost");
  command->add_option("runs", options->runs, "Run files (HDF5), in any state")
      ->required()
      ->type_name("RUN.h5");
  command
      ->add_option("--from", options->window.from,
                   "Means over the times from this one on [s]; default: the second half")
      ->type_name("T")
      ->check(finite_number());
  command->add_option("--to", options->window.to, "Means up to this time [s]")
      ->type_name("T")
      ->check(finite_number());
  command->add_flag("--json", options->json, "JSON, one object per run, instead of CSV");
  command
      ->add_option("-o,--output", options->output, "Output file; default: standard output")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Overwrite the output if it exists");
  command->callback([options] { gather(*options); });
}

} // namespace ehdjet::cli
