#pragma once

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// `ehdjet plot RUN.h5`: one page that shows the jet and its observables, drawn by gnuplot.
void add_plot_command(CLI::App& app);

} // namespace ehdjet::cli
