#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
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
#include "scenes.hpp"
#include "standard_streams.hpp"
#include "version.hpp"

namespace ehdjet::cli {
namespace {

struct BenchOptions {
  std::vector<std::string> rows, overrides;
  std::string scenes, output = "table2";
  std::optional<double> time, rtol, stationary_from;
  std::optional<std::string> solver, method;
  std::optional<std::size_t> threads;
  bool no_serial = false, quiet = false, force = false;
  std::string rates = "both";
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

/// One run of a row of the table, on one thread and on all of them.
struct Row {
  const Table2Row* paper;
  std::string_view rates; // "one" or "two"
  double end_time;
  std::optional<Table2Run> serial;
  Table2Run parallel;

  [[nodiscard]] std::optional<double> efficiency(std::size_t threads) const {
    if (!serial) return std::nullopt;
    return serial->statistics.wall_time
           / (parallel.statistics.wall_time * static_cast<double>(threads));
  }
  [[nodiscard]] double per_ms(double amount) const { return 1e-3 * amount / end_time; }
  /// Coulomb sums, with those between few beads as parts of one.
  [[nodiscard]] double full_sums() const {
    const RunStatistics& s = parallel.statistics;
    const auto all = static_cast<double>(s.evaluations);
    return s.two_rates ? s.two_rates->full_sums : all;
  }
};

/// Exponent of the time per millisecond in the number of links, between the first and the last row
/// that refines; none with fewer than two.
std::optional<double> growth(const std::vector<Row>& rows, std::string_view rates) {
  const Row *first = nullptr, *last = nullptr;
  for (const Row& r : rows)
    if (r.rates == rates && r.paper->length > 0) (first == nullptr ? first : last) = &r;
  if (last == nullptr) return std::nullopt;
  const auto cost = [](const Row& r) {
    return std::log(r.per_ms(r.parallel.statistics.wall_time));
  };
  return (cost(*last) - cost(*first))
         / std::log(last->parallel.stationary_links / first->parallel.stationary_links);
}

std::string number(std::optional<double> value, int digits) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, digits) : "";
}

void write_csv(TextOutput& out, const std::vector<Row>& rows, std::size_t threads) {
  out.print(
      "refinement_length_cm,rates,simulated_s,links_mean,links_stationary,links_before_"
      "refinement,threads,wall_1_s,wall_s,efficiency,evaluations,full_sums,paper_beads,"
      "paper_threads,paper_wall_s,paper_efficiency\n");
  for (const Row& r : rows) {
    const Table2Run& m = r.parallel;
    out.print("{},{},{},{:.3f},{:.3f},{},{},{},{:.3f},{},{},{:.0f},",
              r.paper->length == 0 ? "" : r.paper->name, r.rates == "one" ? 1 : 2,
              r.end_time, m.mean_links, m.stationary_links, number(m.links_before, 3),
              threads, r.serial ? number(r.serial->statistics.wall_time, 3) : "",
              m.statistics.wall_time, number(r.efficiency(threads), 4),
              m.statistics.evaluations, r.full_sums());
    if (r.paper->is_published())
      out.print("{},{},{:.0f},{}\n", r.paper->beads, r.paper->processors, r.paper->wall,
                r.paper->efficiency);
    else
      out.print(",,,\n");
  }
  out.close();
}

std::string markdown(const std::vector<Row>& rows, std::size_t threads) {
  std::string text = fmt::format(
      "| L~ (cm) | rates | simulated (s) | links, mean | stationary | before refining "
      "| wall, 1 thread (s) | wall, {} threads (s) | eta | Coulomb sums per ms | ms per "
      "simulated ms | paper: beads | wall, 24 cores (s) | eta |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      threads);
  for (const Row& r : rows) {
    const Table2Run& m = r.parallel;
    text +=
        fmt::format("| {} | {} | {} | {:.1f} | {:.1f} | {} | {} | {:.2f} | {} | {:.0f} | "
                    "{:.2f} | ",
                    r.paper->name, r.rates, r.end_time, m.mean_links, m.stationary_links,
                    number(m.links_before, 1),
                    r.serial ? number(r.serial->statistics.wall_time, 2) : "",
                    m.statistics.wall_time, number(r.efficiency(threads), 2),
                    r.per_ms(r.full_sums()), 1e3 * r.per_ms(m.statistics.wall_time));
    text += r.paper->is_published() ? fmt::format("{} | {:.0f} | {} |\n", r.paper->beads,
                                                  r.paper->wall, r.paper->efficiency)
                                    : " | | |\n";
  }
  for (const std::string_view rates : {"one", "two"}) {
    double wall = 0, paper = 0, end_time = 0;
    for (const Row& r : rows)
      if (r.rates == rates && r.paper->is_published())
        wall += r.parallel.statistics.wall_time, paper += r.paper->wall,
            end_time = r.end_time;
    if (wall == 0) continue;
    text += fmt::format(
        "\n{} rate{}: the rows of the paper took {:.1f} s on {} thread{} for {:g} s, there "
        "{:.0f} s on 24 cores for 0.2 s.",
        rates == "one" ? "One" : "Two", rates == "one" ? "" : "s", wall, threads,
        threads == 1 ? "" : "s", end_time, paper);
    if (const auto exponent = growth(rows, rates))
      text += fmt::format(
          " The time per simulated ms grows with the links to the power {:.2f}.",
          *exponent);
    text += "\n";
  }
  return text;
}

std::string provenance() {
  std::string text;
  for (const auto& [name, value] : environment())
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, value);
  return text;
}

bool is_chosen(const BenchOptions& options, const Table2Row& row) {
  return std::ranges::find(options.rows, row.name) != options.rows.end();
}

struct Job {
  const Table2Row* row;
  std::string_view rates;
  Scene scene;
};

Scene scene_of(const BenchOptions& options, const Table2Row& row, std::string_view rates) {
  std::vector<std::string> overrides;
  if (!row.is_published())
    overrides = {fmt::format("refinement.length={}", row.length),
                 fmt::format("nozzle.link_length={}", std::min(2e-4, row.length / 2)),
                 "coulomb.solver=\"auto\""};
  std::ranges::move(overrides_of(options), std::back_inserter(overrides)); // these count
  if (rates == "two") overrides.emplace_back("integrator.method=\"two-rate\"");
  const std::string name = fmt::format("{}.toml", row.scene);
  Scene scene =
      read_scene(options.scenes.empty() ? find_scene(name)
                                        : std::filesystem::path(options.scenes) / name,
                 overrides);
  const std::string& method = scene.config.integrator.method;
  if (rates == "one" && (method == "auto" || method == "two-rate"))
    throw InputError(
        fmt::format("integrator.method = \"{}\" has two rates. The rows with one rate need "
                    "another method; --rates two leaves them out",
                    method));
  return scene;
}

Row run_job(const BenchOptions& options, const Job& job, std::size_t threads) {
  const double end = job.scene.config.run.end_time;
  // The jets of the table are stationary after 35 ms.
  const double from = options.stationary_from.value_or(std::min(0.035, end / 2));
  const auto run = [&](std::size_t p) {
    std::optional<Progress> progress;
    if (!options.quiet) {
      message("L~ = {}{}, {} rate{}, {} thread{}, {} s\n", job.row->name,
              job.row->length == 0 ? "" : " cm", job.rates, job.rates == "one" ? "" : "s",
              p, p == 1 ? "" : "s", end);
      progress.emplace(0.0, end);
    }
    const InterruptGuard interrupt;
    return run_table2(job.scene, end, from, p, {}, [&](const Simulation& s) {
      if (progress) progress->show(s);
      if (const char* signal = InterruptGuard::signal_name())
        throw RunError(fmt::format("stopped by {}", signal));
    });
  };
  Row row{
      .paper = job.row, .rates = job.rates, .end_time = end, .serial = {}, .parallel = {}};
  if (!options.no_serial && threads > 1) row.serial = run(1);
  row.parallel = run(threads);
  if (threads == 1) row.serial = row.parallel;
  return row;
}

void bench_table2(const BenchOptions& options) {
  if (options.method && options.rates == "two")
    throw InputError(
        "--method is for the rows with one rate, which --rates two leaves out");
  std::vector<const Table2Row*> lengths;
  for (const Table2Row& row : table2)
    if (options.rows.empty() || is_chosen(options, row)) lengths.push_back(&row);
  for (const Table2Row& row : table2_finer)
    if (is_chosen(options, row)) lengths.push_back(&row);
  std::vector<Job> jobs; // all scenes are read before the first run
  for (const Table2Row* row : lengths)
    for (const std::string_view rates : {"one", "two"})
      if (options.rates == "both" || options.rates == rates)
        jobs.push_back({row, rates, scene_of(options, *row, rates)});
  TextOutput csv(options.output + ".csv", options.force);
  TextOutput table(options.output + ".md", options.force);
  warn_of_threads(options.threads);
  const std::size_t threads = granted_threads(
      options.threads.value_or(static_cast<std::size_t>(omp_get_max_threads())));

  std::vector<Row> rows;
  rows.reserve(jobs.size());
  for (const Job& job : jobs) rows.push_back(run_job(options, job, threads));
  write_csv(csv, rows, threads);
  const std::string text = markdown(rows, threads);
  table.print("{}\n{}\n", text, provenance());
  table.close();
  print_result("{}\nwritten to {}.csv and {}.md\n", text, options.output, options.output);
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
  std::ranges::transform(table2_finer, std::back_inserter(names), &Table2Row::name);
  command
      ->add_option(
          "--rows", options->rows,
          "Rows, separated by commas: none,0.8,0.4,0.2 (L~ in cm), all by default, and "
          "0.1,0.05,0.02, which take long with one rate; the latter with coulomb.solver = "
          "\"auto\"")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command
      ->add_option("--time", options->time, "Simulated time [s]; default: the scene's, 0.2")
      ->type_name("T")
      ->check(finite_number());
  command->add_option("--rtol", options->rtol, "Tolerance of the integrator");
  command->add_option("--solver", options->solver, "Coulomb solver");
  command->add_option("--method", options->method, "Integrator of the runs with one rate");
  command
      ->add_option(
          "--rates", options->rates,
          "Runs with one rate, with two (integrator.method = \"two-rate\"), or both")
      ->check(CLI::IsMember({"one", "two", "both"}))
      ->capture_default_str();
  add_set_option(*command, options->overrides,
                 "Override a key of all scenes: table.key=value (repeatable)");
  add_threads_option(*command, options->threads);
  command->add_flag(
      "--no-serial", options->no_serial,
      "Do not also run on one thread; this leaves out the parallel efficiency");
  command
      ->add_option("--stationary-from", options->stationary_from,
                   "Start of the stationary means [s]; default: 0.035 or half of the run")
      ->type_name("T")
      ->check(finite_number());
  command->add_option("--scenes", options->scenes,
                      "Folder with table2_none.toml, ...; default: the scenes that `ehdjet "
                      "scenes` lists");
  command->add_option("-o,--output", options->output, "Writes OUTPUT.csv and OUTPUT.md")
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "No progress");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { bench_table2(*options); });
}

} // namespace ehdjet::cli
