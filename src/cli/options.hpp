#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
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

/// A check of an option with a number: neither infinite nor NaN.
CLI::Validator finite_number();
/// Says on standard output where a command has written to. Whoever gave the name (`given`) reads it at a terminal only.
void say_written(const std::filesystem::path& file, bool given);

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads);
/// Says so if fewer threads run than were asked for, by an option or OMP_NUM_THREADS.
void warn_of_threads(std::optional<std::size_t> asked);

} // namespace ehdjet::cli
