#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/coulomb/measure_costs.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/scene/calibration_file.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <string>
#include <unistd.h>

#include "commands.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

struct CalibrateOptions {
  std::string output = "calibration.toml";
  SimdLevel simd = best_simd_level();
  std::optional<std::size_t> threads;
  bool force = false, disturbed = false;
};

/// Shows how far the measurement is, and counts the timings that something else disturbed.
class Watch {
public:
  void operator()(const CostTiming& timing) {
    constexpr double quiet = 1.3;
    all_ = timing.all;
    if (timing.spread > quiet) ++disturbed_;
    worst_ = std::max(worst_, timing.spread);
    const auto now = std::chrono::steady_clock::now();
    const bool terminal = isatty(STDERR_FILENO) != 0;
    if (now - shown_ < std::chrono::milliseconds(terminal ? 200 : 5000)) return;
    shown_ = now;
    write_to_terminal(fmt::format("{}{} of {} timings, {} disturbed{}",
                                  terminal ? "\r" : "", timing.number, timing.all,
                                  disturbed_, terminal ? "\033[K" : "\n"));
  }
  void end() const {
    if (isatty(STDERR_FILENO) != 0) write_to_terminal("\r\033[K");
  }
  [[nodiscard]] bool is_disturbed() const { return 10 * disturbed_ > all_; }
  [[nodiscard]] std::string text() const {
    return fmt::format(
        "{} of {} timings were disturbed (the median of their calls took up to {:.1f} "
        "times as long as the shortest one)",
        disturbed_, all_, worst_);
  }

private:
  std::size_t disturbed_ = 0, all_ = 0;
  double worst_ = 1;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

void calibrate(const CalibrateOptions& options) {
  warn_of_threads(options.threads);
  const ThreadCount threads(options.threads);
  // Refuses an existing file before the measurement.
  TextOutput output(options.output, options.force);
  message("timing the Coulomb solvers, about a minute\n");
  Watch watch;
  const CostModel model =
      measure_costs(options.simd, [&](const CostTiming& t) { watch(t); });
  watch.end();
  if (watch.is_disturbed() && !options.disturbed)
    throw RunError(
        watch.text()
        + ". Nothing has been written. Calibrate while nothing else runs, or take "
          "the times as they are with --disturbed");
  output.print(
      "{}", calibration_text(model, fmt::format("{} threads, {}; {}", omp_get_max_threads(),
                                                name_of(options.simd), watch.text())));
  output.close();
  print_result("direct sum up to\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-6, 1e-9, 1e-12})
    print_result(
        "  {:>9} beads of a jet, {:>9} charges that fill space, at a tolerance of {:g}\n",
        model.crossover(tolerance), model.crossover(tolerance, 1), tolerance);
  print_result("written to {}; use it with --calibration {}\n", options.output,
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
  command->add_flag("--disturbed", options->disturbed,
                    "Write the costs even if something else disturbed the timings");
  command->add_flag("--force", options->force, "Overwrite the file if it exists");
  command->callback([options] { calibrate(*options); });
}

} // namespace ehdjet::cli
