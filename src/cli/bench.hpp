#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet bench table2`: cost against the refinement length, next to the paper's Table 2.
void add_bench_command(CLI::App& app);

} // namespace ehdjet::cli
