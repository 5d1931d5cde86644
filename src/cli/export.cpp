#include "ehdjet/io/export.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/read_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
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

struct Part {
  const char *name, *help;
  bool of_frames = false; ///< --time chooses one
};
constexpr Part parts[] = {
    {"observables", "CSV: the observables over time"},
    {"beads", "CSV: the beads of one frame, the last one by default", true},
    {"deposit", "CSV: the deposited fibre"},
    {"deposit-xyz", "Extended XYZ: the deposited fibre"},
    {"deposit-vtk", "ParaView: the deposited fibre as poly-lines (.vtp)"},
    {"refinements", "CSV: changes by each mesh refinement"},
    {"budget", "CSV: energy and momentum over time, and their residual"},
    {"resolving-power", "CSV: mean and least resolving power link_length/l along the jet"},
    {"xyz", "Extended XYZ: all frames (OVITO, ASE) or, with --time, one (also VMD)", true},
    {"xdmf", "ParaView: a .xdmf file that shows the frames in the run file itself", true},
    {"jetspin-stat", "Observables as JETSPIN's statout.dat, in cgs units"},
    {"vtk", "ParaView: a .pvd file and a folder of poly-lines, one per frame", true}};

void run_export(Options options) {
  if (options.time && !std::ranges::find(parts, options.part, &Part::name)->of_frames)
    throw InputError(fmt::format("--time {} s has no meaning with --{}, which is not of "
                                 "one instant. Remove it",
                                 *options.time, options.part));
  const RunReader run(options.run);
  if (options.part == "jetspin-stat" && config_of(run.scene("resolved")).array)
    throw InputError(fmt::format(
        "{} is a run of several jets, and JETSPIN's statistics are those of one",
        options.run));
  const bool named = !options.output.empty();
  if (options.part == "xdmf"
      && options.output.empty()) // beside the run file, to which it refers
    options.output = fs::path(options.run).replace_extension("xdmf").string();
  if (options.part == "vtk") {
    const fs::path pvd = options.output.empty()
                             ? fs::path(options.run).replace_extension("pvd")
                             : fs::path(options.output);
    export_vtk(run, options.time, pvd, options.force);
    say_written(pvd, named);
    return;
  }
  std::optional<TextOutput> file;
  if (!options.output.empty()) file.emplace(options.output, options.force, options.run);
  TextOutput standard;
  TextOutput& output = file ? *file : standard;
  if (options.part == "beads")
    export_beads(run, options.time, output);
  else if (options.part == "resolving-power")
    export_resolving_power(run, options.from, output);
  else if (options.part == "deposit-xyz")
    export_deposit_xyz(run, output);
  else if (options.part == "deposit-vtk")
    export_deposit_vtk(run, output);
  else if (options.part == "xdmf")
    export_xdmf(run, options.time, options.output, output);
  else if (options.part == "jetspin-stat")
    export_jetspin_statistics(run, output);
  else if (options.part == "xyz")
    export_xyz(run, options.time, output);
  else
    export_table(run, options.part, output);
  if (!options.output.empty()) say_written(options.output, named);
}

} // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write parts of a run file as CSV, XYZ or VTK (SI units), or as JETSPIN does");
  add_run_file_option(*command, options->run);
  CLI::Option_group* format = command->add_option_group("Format", "one of");
  for (const auto& [part, help, of_frames] : parts)
    format->add_flag_callback(
        std::string("--") + part, [options, name = part] { options->part = name; }, help);
  format->require_option(1);
  command
      ->add_option(
          "--time", options->time,
          "Take the frame nearest to this time [s]; of --beads, --xyz, --vtk, --xdmf")
      ->type_name("T")
      ->check(finite_number());
  command
      ->add_option("--from", options->from,
                   "Mean over the times from this one on [s]; default: the second half")
      ->type_name("T")
      ->check(finite_number())
      ->needs(format->get_option("--resolving-power"));
  command
      ->add_option("-o,--output", options->output,
                   "Output file; default: standard output, for --vtk and --xdmf RUN.pvd "
                   "and RUN.xdmf beside the run file")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { run_export(*options); });
}

} // namespace ehdjet::cli
