#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet check SCENE`: says what a scene is and what would be simulated, without running it.
void add_check_command(CLI::App& app);

} // namespace ehdjet::cli
