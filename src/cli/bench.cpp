#include "ehdjet/core/error.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/studies/table2.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <memory>

#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "version.hpp"

namespace ehdjet::cli {
namespace {

struct BenchOptions {
  std::vector<std::string> rows, overrides;
  std::string scenes = "scenes", output = "table2";
  std::optional<double> time, rtol, stationary_from;
  std::optional<std::string> solver, method;
  std::optional<std::size_t> threads;
  bool no_serial = false, quiet = false, force = false;
};

std::vector<std::string> overrides_of(const BenchOptions& options) {
  std::vector<std::string> all = options.overrides;
  if (options.time) all.push_back(fmt::format("run.end_time={}", *options.time));
  if (options.rtol) all.push_back(fmt::format("integrator.rtol={}", *options.rtol));
  if (options.solver) all.push_back(fmt::format("coulomb.solver=\"{}\"", *options.solver));
  if (options.method)
    all.push_back(fmt::format("integrator.method=\"{}\"", *options.method));
  return all;
}

struct Row {
  const Table2Row* paper;
  double end_time;
  std::optional<Table2Run> serial;
  Table2Run parallel;

  [[nodiscard]] std::optional<double> efficiency(std::size_t threads) const {
    if (!serial) return std::nullopt;
    return serial->statistics.wall_time
           / (parallel.statistics.wall_time * static_cast<double>(threads));
  }
  [[nodiscard]] double microseconds() const { // per evaluation, with all threads
    return 1e6 * parallel.statistics.wall_time
           / static_cast<double>(parallel.statistics.evaluations);
  }
};

std::string number(std::optional<double> value, int digits) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, digits) : "";
}

void write_csv(TextOutput& out, const std::vector<Row>& rows, std::size_t threads) {
  out.print("refinement_length_cm,simulated_s,beads_mean,beads_stationary,beads_before_"
            "refinement,"
            "threads,wall_1_s,wall_s,efficiency,evaluations,us_per_evaluation,paper_beads,"
            "paper_threads,paper_wall_s,paper_efficiency\n");
  for (const Row& r : rows) {
    const Table2Run& m = r.parallel;
    out.print("{},{},{:.3f},{:.3f},{},{},{},{:.3f},{},{},{:.3f},{},{},{:.0f},{}\n",
              r.paper->length == 0 ? "" : r.paper->name, r.end_time, m.mean_beads,
              m.stationary_beads, number(m.beads_before, 3), threads,
              r.serial ? number(r.serial->statistics.wall_time, 3) : "",
              m.statistics.wall_time, number(r.efficiency(threads), 4),
              m.statistics.evaluations, r.microseconds(), r.paper->beads,
              r.paper->processors, r.paper->wall, r.paper->efficiency);
  }
  out.close();
}

std::string markdown(const std::vector<Row>& rows, std::size_t threads) {
  std::string text = fmt::format("| L~ (cm) | simulated (s) | beads, mean | stationary | "
                                 "before refining | wall, 1 thread (s) | "
                                 "wall, {} threads (s) | eta | evaluations | us per "
                                 "evaluation | paper: beads | wall, 24 "
                                 "cores (s) | eta |\n"
                                 "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
                                 threads);
  double wall = 0, paper = 0;
  for (const Row& r : rows) {
    const Table2Run& m = r.parallel;
    text += fmt::format(
        "| {} | {} | {:.1f} | {:.1f} | {} | {} | {:.2f} | {} | {} | {:.1f} | {} | "
        "{:.0f} | {} |\n",
        r.paper->name, r.end_time, m.mean_beads, m.stationary_beads,
        number(m.beads_before, 1),
        r.serial ? number(r.serial->statistics.wall_time, 2) : "", m.statistics.wall_time,
        number(r.efficiency(threads), 2), m.statistics.evaluations, r.microseconds(),
        r.paper->beads, r.paper->wall, r.paper->efficiency);
    wall += m.statistics.wall_time, paper += r.paper->wall;
  }
  return text
         + fmt::format(
             "\nAll rows: {:.1f} s on {} threads; the paper: {:.0f} s on 24 cores.\n", wall,
             threads, paper);
}

std::string provenance() {
  std::string text;
  for (const auto& [name, value] : environment())
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, value);
  return text;
}

void bench_table2(const BenchOptions& options) {
  std::vector<const Table2Row*> chosen;
  std::vector<Scene> scenes; // all of them are read before the first run
  for (const Table2Row& row : table2) {
    if (!options.rows.empty()
        && std::ranges::find(options.rows, row.name) == options.rows.end())
      continue;
    chosen.push_back(&row);
    scenes.push_back(read_scene(std::filesystem::path(options.scenes)
                                    / fmt::format("{}.toml", row.scene),
                                overrides_of(options)));
  }
  TextOutput csv(options.output + ".csv", options.force);
  TextOutput table(options.output + ".md", options.force);
  const std::size_t threads =
      options.threads.value_or(static_cast<std::size_t>(omp_get_max_threads()));

  std::vector<Row> rows;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const double end = scenes[i].config.run.end_time;
    // The jets of the table are stationary after 35 ms.
    const double from = options.stationary_from.value_or(std::min(0.035, end / 2));
    const auto run = [&](std::size_t p) {
      std::optional<Progress> progress;
      if (!options.quiet) {
        fmt::print(stderr, "L~ = {}{}, {} thread{}, {} s\n", chosen[i]->name,
                   chosen[i]->length == 0 ? "" : " cm", p, p == 1 ? "" : "s", end);
        progress.emplace(0.0, end);
      }
      const InterruptGuard interrupt;
      return run_table2(scenes[i], end, from, p, {}, [&](const Simulation& s) {
        if (progress) progress->show(s);
        if (const char* signal = InterruptGuard::signal_name())
          throw RunError(fmt::format("stopped by {}", signal));
      });
    };
    Row row{.paper = chosen[i], .end_time = end, .serial = {}, .parallel = {}};
    if (!options.no_serial && threads > 1) row.serial = run(1);
    row.parallel = run(threads);
    if (threads == 1) row.serial = row.parallel;
    rows.push_back(row);
  }
  write_csv(csv, rows, threads);
  const std::string text = markdown(rows, threads);
  table.print("{}\n{}\n", text, provenance());
  table.close();
  fmt::print("{}\nwritten to {}.csv and {}.md\n", text, options.output, options.output);
}

} // namespace

void add_bench_command(CLI::App& app) {
  CLI::App* bench = app.add_subcommand("bench", "Measure what runs cost");
  bench->require_subcommand(1);
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = bench->add_subcommand(
      "table2", "Cost against the refinement length, next to the paper's Table 2");
  std::vector<std::string> names;
  std::ranges::transform(table2, std::back_inserter(names), &Table2Row::name);
  command
      ->add_option("--rows", options->rows,
                   "Rows, separated by commas: none,0.8,0.4,0.2 (L~ in cm); default: all")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command
      ->add_option("--time", options->time, "Simulated time [s]; default: the scene's, 0.2")
      ->type_name("T");
  command->add_option("--rtol", options->rtol, "Tolerance of the integrator");
  command->add_option("--solver", options->solver, "Coulomb solver");
  command->add_option("--method", options->method, "Integrator");
  add_set_option(*command, options->overrides,
                 "Override a key of all scenes: table.key=value (repeatable)");
  add_threads_option(*command, options->threads);
  command->add_flag(
      "--no-serial", options->no_serial,
      "Do not also run on one thread; this leaves out the parallel efficiency");
  command
      ->add_option("--stationary-from", options->stationary_from,
                   "Start of the stationary means [s]; default: 0.035 or half of the run")
      ->type_name("T");
  command->add_option("--scenes", options->scenes, "Folder with table2_none.toml, ...")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Writes OUTPUT.csv and OUTPUT.md")
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "No progress");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { bench_table2(*options); });
}

} // namespace ehdjet::cli
