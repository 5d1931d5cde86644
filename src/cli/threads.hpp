#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// --threads N
void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads);

/// --calibration FILE
void add_calibration_option(CLI::App& command, std::string& file);
/// Overrides of a scene's keys, with a calibration that was given beside the scene among them.
std::vector<std::string> with_calibration(std::vector<std::string> overrides,
                                          const std::string& file);

/// Sets the number of threads of everything that follows; without a number, all processors.
void use_threads(std::optional<std::size_t> threads);

} // namespace ehdjet::cli
