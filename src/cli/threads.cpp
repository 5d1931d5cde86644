#include "threads.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace ehdjet::cli {

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads) {
  command.add_option("--threads", threads, "Number of threads; default: all processors")
      ->check(CLI::Range(1, 4096));
}

void add_calibration_option(CLI::App& command, std::string& file) {
  command
      .add_option("--calibration", file,
                  "Costs that solver = \"auto\" goes by, written by `ehdjet calibrate`")
      ->type_name("FILE");
}

std::vector<std::string> with_calibration(std::vector<std::string> overrides,
                                          const std::string& file) {
  if (!file.empty()) // a path in a scene is relative to the scene
    overrides.push_back(fmt::format("coulomb.calibration=\"{}\"",
                                    std::filesystem::absolute(file).string()));
  return overrides;
}

void use_threads(std::optional<std::size_t> threads) {
  if (threads) omp_set_num_threads(static_cast<int>(*threads));
}

} // namespace ehdjet::cli
