#include "ehdjet/io/export.hpp"

#include <filesystem>
#include <memory>
#include <utility>

#include "commands.hpp"
#include "options.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string run, output, part;
  std::optional<double> time, from;
  bool force = false;
};

constexpr std::pair<const char*, const char*> parts[] = {
    {"observables", "CSV: the observables over time"},
    {"beads", "CSV: the beads of one frame, the last one by default"},
    {"deposit", "CSV: the deposited fibre"},
    {"refinements", "CSV: changes by each mesh refinement"},
    {"budget", "CSV: energy and momentum over time, and their residual"},
    {"resolving-power", "CSV: mean and least resolving power link_length/l along the jet"},
    {"xyz", "Extended XYZ: all frames (OVITO) or, with --time, one (also VMD)"},
    {"vtk", "ParaView: a .pvd file and a folder of poly-lines, one per frame"}};

void run_export(const Options& options) {
  const RunReader run(options.run);
  if (options.part == "vtk") {
    const fs::path pvd = options.output.empty()
                             ? fs::path(options.run).replace_extension("pvd")
                             : fs::path(options.output);
    export_vtk(run, options.time, pvd, options.force);
    return;
  }
  TextOutput output =
      options.output.empty() ? TextOutput() : TextOutput(options.output, options.force);
  if (options.part == "beads")
    export_beads(run, options.time, output);
  else if (options.part == "resolving-power")
    export_resolving_power(run, options.from, output);
  else if (options.part == "xyz")
    export_xyz(run, options.time, output);
  else
    export_table(run, options.part, output);
}

} // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "export", "Write parts of a run file as CSV, XYZ or VTK (SI units)");
  add_run_file_option(*command, options->run);
  CLI::Option_group* format = command->add_option_group("Format", "one of");
  for (const auto& [part, help] : parts)
    format->add_flag_callback(
        std::string("--") + part, [options, name = part] { options->part = name; }, help);
  format->require_option(1);
  command->add_option("--time", options->time, "Take the frame nearest to this time [s]")
      ->type_name("T");
  command
      ->add_option("--from", options->from,
                   "Mean over the times from this one on [s]; default: the second half")
      ->type_name("T")
      ->needs(format->get_option("--resolving-power"));
  command
      ->add_option(
          "-o,--output", options->output,
          "Output file; default: standard output, for --vtk RUN.pvd beside the run file")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { run_export(*options); });
}

} // namespace ehdjet::cli
