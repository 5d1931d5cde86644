#include "options.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace ehdjet::cli {

CLI::Option* SceneOptions::add_to(CLI::App& command) {
  CLI::Option* option = command.add_option("SCENE", scene, "Scene file (TOML)");
  add_set_option(command, overrides, "Override a key: table.key=value (repeatable)");
  add_calibration_option(command, calibration);
  return option;
}

Scene SceneOptions::read() const {
  std::vector<std::string> all = overrides;
  if (!calibration.empty()) // a relative path in a scene would be relative to the scene
    all.push_back(fmt::format("coulomb.calibration=\"{}\"",
                              std::filesystem::absolute(calibration).string()));
  return read_scene(scene, all);
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides,
                    const std::string& help) {
  command.add_option("--set", overrides, help)
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_calibration_option(CLI::App& command, std::string& file) {
  command
      .add_option("--calibration", file,
                  "Costs by which solver = \"auto\" chooses, written by `ehdjet calibrate`")
      ->type_name("FILE");
}

void add_run_file_option(CLI::App& command, std::string& file) {
  command.add_option("run", file, "Run file (HDF5)")->required()->type_name("RUN.h5");
}

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads) {
  command.add_option("--threads", threads, "Number of threads; default: all processors")
      ->check(CLI::Range(1, 4096));
}

} // namespace ehdjet::cli
