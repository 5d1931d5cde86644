#include "calibrate.hpp"

#include "ehdjet/coulomb/cost_model.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/scene/calibration_file.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string>

#include "threads.hpp"
#include "version.hpp"

namespace ehdjet::cli {
namespace {

struct CalibrateOptions {
  std::string output = "calibration.toml";
  std::optional<std::size_t> threads;
  bool force = false;
};

void calibrate(const CalibrateOptions& options) {
  use_threads(options.threads);
  TextOutput output(options.output, options.force); // an existing file is refused now
  fmt::print(stderr, "timing the Coulomb solvers, about a minute\n");
  const CostModel model = CostModel::measured();
  output.print("{}",
               calibration_text(model, fmt::format("{} threads, {}", omp_get_max_threads(),
                                                   environment().at("simd"))));
  output.close();
  fmt::print("direct sum up to\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-6, 1e-9, 1e-12})
    fmt::print("  {:>9} beads at a tolerance of {:g}\n", model.crossover(tolerance),
               tolerance);
  fmt::print("written to {}; use it with --calibration {}\n", options.output,
             options.output);
}

} // namespace

void add_calibrate_command(CLI::App& app) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Measure what the Coulomb solvers cost here, for solver = \"auto\"");
  command->add_option("-o,--output", options->output, "File to write (TOML)")
      ->capture_default_str();
  add_threads_option(*command, options->threads);
  command->add_flag("--force", options->force, "Overwrite the file if it exists");
  command->callback([options] { calibrate(*options); });
}

} // namespace ehdjet::cli
