#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/jetspin/import_input.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "commands.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

struct ImportOptions {
  std::string input, output;
  JetspinImportOptions jetspin;
  bool force = false;
};

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file))
    throw InputError(fmt::format("{}: cannot be read", file));
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& text, bool force) {
  TextOutput output = file.empty() ? TextOutput() : TextOutput(file, force);
  output.print("{}", text);
  output.close();
}

void run_import(ImportOptions options) {
  const fs::path scene_file = options.output;
  const fs::path beads_file = fs::path(scene_file).replace_extension("csv");
  options.jetspin.beads_file = beads_file.filename().string();
  if (!options.output.empty())
    for (const fs::path& output : {scene_file, beads_file})
      refuse_input(output, options.input);
  const std::string input = text_of(options.input);
  const ImportedScene scene = import_jetspin(input, options.input, options.jetspin);
  for (const std::string& r : scene.remarks) message("{}\n", r);
  if (!scene.beads.empty()) {
    if (options.output.empty())
      throw InputError(fmt::format("{}: \"inserting no\": the scene needs a file of beads "
                                   "beside it. Give -o SCENE.toml",
                                   options.input));
    if (beads_file == scene_file)
      throw InputError(fmt::format(
          "{}: give the scene another ending, its beads are written to that file",
          scene_file.string()));
    static_cast<void>(
        NewFile(scene_file, options.force)); // refuses an existing file before the work
    NewFile beads(beads_file, options.force);
    const fs::path there = beads.create();
    write(there, scene.beads, true);
    // Checked with the beads where they are, before they replace older ones.
    options.jetspin.beads_file = fs::absolute(there).string();
    check_imported(import_jetspin(input, options.input, options.jetspin), options.input,
                   scene_file.parent_path());
    beads.publish();
  } else {
    check_imported(scene, options.input, scene_file.parent_path());
  }
  write(scene_file, scene.text, options.force);
  if (!options.output.empty())
    message("written to {}{}{}\n", options.output, scene.beads.empty() ? "" : " and ",
            scene.beads.empty() ? "" : beads_file.string());
}

} // namespace

void add_import_command(CLI::App& app) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = app.add_subcommand(
      "import", "Turn an input file of JETSPIN into a scene (docs/jetspin.md)");
  command->add_option("INPUT", options->input, "Input file of JETSPIN, as input.dat")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "Scene to write; default: standard output")
      ->type_name("SCENE.toml");
  command->add_flag("--without-noise", options->jetspin.without_noise,
                    "Leave out random forces, which ehdjet does not have");
  command->add_flag(
      "--fixed-steps", options->jetspin.fixed_steps,
      "Keep JETSPIN's method, its time step and its events at the ends of steps");
  command->add_flag("--force", options->force, "Overwrite existing files");
  command->callback([options] { run_import(*options); });
}

} // namespace ehdjet::cli
