#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet export RUN.h5`: parts of a run file in formats that other programs read.
void add_export_command(CLI::App& app);

} // namespace ehdjet::cli
