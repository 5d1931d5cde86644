#pragma once

namespace CLI {
class App;
}

/// Each function adds one command to the program.
namespace ehdjet::cli {

/// `ehdjet run SCENE`: simulates a scene and writes a run file.
void add_run_command(CLI::App& app);
/// `ehdjet check SCENE`: reports what a scene would simulate, without running it.
void add_check_command(CLI::App& app);
/// `ehdjet scenes`: lists the scenes that come with the program.
void add_scenes_command(CLI::App& app);
/// `ehdjet info RUN.h5`: what a run file or a scene holds.
void add_info_command(CLI::App& app);
/// `ehdjet forces BEADS.csv`: the Coulomb force on given charges, with its time and error.
void add_forces_command(CLI::App& app);
/// `ehdjet export RUN.h5`: writes parts of a run file in formats that other programs read.
void add_export_command(CLI::App& app);
/// `ehdjet import input.dat`: turns an input file of JETSPIN into a scene.
void add_import_command(CLI::App& app);
/// `ehdjet plot RUN.h5`: draws the jet and its observables on one page, with gnuplot.
void add_plot_command(CLI::App& app);
/// `ehdjet sweep PLAN`: scene files for every combination of the values in a plan.
void add_sweep_command(CLI::App& app);
/// `ehdjet gather RUN.h5...`: one table of many runs: what differs, results, cost.
void add_gather_command(CLI::App& app);
/// `ehdjet bench table2`: cost against the refinement length, next to the paper's Table 2.
void add_bench_command(CLI::App& app);
/// `ehdjet calibrate -o FILE`: measures the cost of the Coulomb solvers on this machine.
void add_calibrate_command(CLI::App& app);
/// `ehdjet completion` and `ehdjet manual`: what is made from the commands and options themselves.
void add_command_tree_commands(CLI::App& app);

/// Starts the program again with a bound on how long idle threads spin, unless the environment has one.
/// Call first in `main`.
void bound_waiting(char** argv);

} // namespace ehdjet::cli
