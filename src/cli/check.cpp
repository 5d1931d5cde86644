#include "check.hpp"

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/simulation/build.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

#include "calibrate.hpp"

namespace ehdjet::cli {
namespace {

struct CheckOptions {
  std::string scene, calibration;
  std::vector<std::string> overrides;
  bool keys = false;
};

void check(const CheckOptions& options) {
  if (options.keys) {
    fmt::print("{}", key_reference());
    return;
  }
  const Scene scene =
      read_scene(options.scene, with_calibration(options.overrides, options.calibration));
  build_simulation(scene); // finds errors that only appear when the objects are built
  fmt::print("{}", scene_report(scene));
}

} // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Validate a scene and say what would be simulated, without running it");
  auto* scene = command->add_option("SCENE", options->scene, "Scene file (TOML)");
  command
      ->add_option("--set", options->overrides,
                   "Override a key: table.key=value (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_calibration_option(*command, options->calibration);
  auto* keys = command->add_flag("--keys", options->keys,
                                 "Print the reference of all tables and keys (Markdown)");
  keys->excludes(scene);
  command->callback([options, scene] {
    if (!options->keys && scene->empty()) throw CLI::RequiredError("SCENE");
    check(*options);
  });
}

} // namespace ehdjet::cli
