#include "export.hpp"

#include "ehdjet/io/export.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace ehdjet::cli {

namespace fs = std::filesystem;

namespace {

struct Options {
  std::string run, output;
  bool observables = false, beads = false, deposit = false, xyz = false, vtk = false;
  bool refinements = false, budget = false, resolving_power = false;
  std::optional<double> time, from;
  bool force = false;
};

void run_export(const Options& options) {
  const RunReader run(options.run);
  if (options.vtk) {
    const fs::path pvd = options.output.empty()
                             ? fs::path(options.run).replace_extension("pvd")
                             : fs::path(options.output);
    export_vtk(run, options.time, pvd, options.force);
    return;
  }
  TextOutput output =
      options.output.empty() ? TextOutput() : TextOutput(options.output, options.force);
  if (options.observables) export_observables(run, output);
  if (options.beads) export_beads(run, options.time, output);
  if (options.deposit) export_deposit(run, output);
  if (options.refinements) export_refinements(run, output);
  if (options.budget) export_budget(run, output);
  if (options.resolving_power) export_resolving_power(run, options.from, output);
  if (options.xyz) export_xyz(run, options.time, output);
}

} // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<Options>(); // shared with the callback
  CLI::App* command = app.add_subcommand(
      "export", "Write parts of a run file as CSV, XYZ or VTK (SI units)");
  command->add_option("run", options->run, "Run file (HDF5)")
      ->required()
      ->type_name("RUN.h5");
  CLI::Option_group* format = command->add_option_group("Format", "one of");
  format->add_flag("--observables", options->observables, "CSV: the observables over time");
  format->add_flag("--beads", options->beads,
                   "CSV: the beads of one frame, the last one by default");
  format->add_flag("--deposit", options->deposit, "CSV: the deposited fibre");
  format->add_flag("--refinements", options->refinements,
                   "CSV: changes by each mesh refinement");
  format->add_flag("--budget", options->budget,
                   "CSV: energy and momentum over time, and their residual");
  CLI::Option* power =
      format->add_flag("--resolving-power", options->resolving_power,
                       "CSV: mean and least resolving power link_length/l along the jet");
  format->add_flag("--xyz", options->xyz,
                   "Extended XYZ: all frames (OVITO) or, with --time, one (also VMD)");
  format->add_flag("--vtk", options->vtk,
                   "ParaView: a .pvd file and a folder of poly-lines, one per frame");
  format->require_option(1);
  command->add_option("--time", options->time, "Take the frame nearest to this time [s]")
      ->type_name("T");
  command
      ->add_option("--from", options->from,
                   "Mean over the times from this one on [s]; default: the second half")
      ->type_name("T")
      ->needs(power);
  command
      ->add_option(
          "-o,--output", options->output,
          "Output file; default: standard output, for --vtk RUN.pvd beside the run file")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { run_export(*options); });
}

} // namespace ehdjet::cli
