#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/simulation/build.hpp"

#include <fmt/format.h>
#include <memory>

#include "commands.hpp"
#include "options.hpp"

namespace ehdjet::cli {

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Validate a scene and say what would be simulated, without running it");
  CLI::Option* scene = options->add_to(*command);
  CLI::Option* keys =
      command->add_flag("--keys")
          ->description("Print the reference of all tables and keys (Markdown)")
          ->excludes(scene);
  command->callback([options, scene, keys] {
    if (!keys->empty()) {
      fmt::print("{}", key_reference());
      return;
    }
    if (scene->empty()) throw CLI::RequiredError("SCENE");
    const Scene read = options->read();
    // Finds errors that only appear when the objects are built.
    if (read.config.array)
      build_array_simulation(read);
    else
      build_simulation(read);
    fmt::print("{}", scene_report(read));
  });
}

} // namespace ehdjet::cli
