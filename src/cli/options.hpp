#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// Options that several commands have.
namespace ehdjet::cli {

/// A scene and the keys that the command line overrides: SCENE, --set, --calibration.
struct SceneOptions {
  std::string scene, calibration;
  std::vector<std::string> overrides;

  /// Adds the options to a command and returns SCENE.
  CLI::Option* add_to(CLI::App& command);
  [[nodiscard]] Scene read() const;
};

void add_set_option(CLI::App& command, std::vector<std::string>& overrides,
                    const std::string& help);
void add_calibration_option(CLI::App& command, std::string& file);
void add_run_file_option(CLI::App& command, std::string& file);

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads);

} // namespace ehdjet::cli
