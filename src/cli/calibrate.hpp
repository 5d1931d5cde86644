#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet calibrate -o FILE`: measures what the Coulomb solvers cost on this machine.
void add_calibrate_command(CLI::App& app);

} // namespace ehdjet::cli
