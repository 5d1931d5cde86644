#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/coulomb/cost_model.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/scene/calibration_file.hpp"

#include <fmt/format.h>
#include <map>
#include <memory>

#include "commands.hpp"
#include "options.hpp"

namespace ehdjet::cli {
namespace {

struct CalibrateOptions {
  std::string output = "calibration.toml";
  SimdLevel simd = best_simd_level();
  std::optional<std::size_t> threads;
  bool force = false;
};

void calibrate(const CalibrateOptions& options) {
  const ThreadCount threads(options.threads);
  // Refuses an existing file before the measurement.
  TextOutput output(options.output, options.force);
  fmt::print(stderr, "timing the Coulomb solvers, about a minute\n");
  const CostModel model = CostModel::measured(options.simd);
  output.print("{}",
               calibration_text(model, fmt::format("{} threads, {}", omp_get_max_threads(),
                                                   name_of(options.simd))));
  output.close();
  fmt::print("direct sum up to\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-6, 1e-9, 1e-12})
    fmt::print(
        "  {:>9} beads of a jet, {:>9} charges that fill space, at a tolerance of {:g}\n",
        model.crossover(tolerance), model.crossover(tolerance, 1), tolerance);
  fmt::print("written to {}; use it with --calibration {}\n", options.output,
             options.output);
}

} // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Measure the costs of the Coulomb solvers here, for solver = \"auto\"");
  command->add_option("-o,--output", options->output, "File to write (TOML)")
      ->capture_default_str();
  add_threads_option(*command, options->threads);
  std::map<std::string, SimdLevel> levels;
  for (const SimdLevel level : simd_levels)
    if (level <= best_simd_level()) levels[std::string(name_of(level))] = level;
  command
      ->add_option("--simd", options->simd, "Instruction set; default: the widest there is")
      ->transform(CLI::CheckedTransformer(levels));
  command->add_flag("--force", options->force, "Overwrite the file if it exists");
  command->callback([options] { calibrate(*options); });
}

} // namespace ehdjet::cli
