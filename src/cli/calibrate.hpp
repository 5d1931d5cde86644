#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet calibrate -o FILE`: measures what the Coulomb solvers cost on this machine.
void add_calibrate_command(CLI::App& app);

/// --calibration FILE
void add_calibration_option(CLI::App& command, std::string& file);
/// Overrides of a scene's keys, with a calibration that was given beside the scene among them.
std::vector<std::string> with_calibration(std::vector<std::string> overrides,
                                          const std::string& file);

} // namespace ehdjet::cli
