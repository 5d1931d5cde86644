#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet run SCENE`: simulates a scene and writes a run file.
void add_run_command(CLI::App& app);

} // namespace ehdjet::cli
