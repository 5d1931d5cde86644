#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet forces BEADS.csv`: the Coulomb force on given charges, with its time and error.
void add_forces_command(CLI::App& app);

} // namespace ehdjet::cli
