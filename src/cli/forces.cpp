#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/scene/calibration_file.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <sys/resource.h>

#include "commands.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

struct ForcesOptions {
  std::string beads, output, calibration, solver = "direct";
  std::optional<double> tolerance;
  ToleranceNorm norm = ToleranceNorm::global;
  std::optional<std::size_t> threads;
  int repeat = 1;
  bool check = true, force = false;
};

struct Charges {
  std::vector<double> x, y, z, q;
  [[nodiscard]] ConstVec3View positions() const { return {x, y, z}; }
};

/// `file`: "-" is the standard input.
Charges read_charges(const std::string& file) {
  // Each column by its short name or by that in the CSV files that ehdjet exports.
  const std::vector<std::string> names{"x", "y", "z", "q", "x_m", "y_m", "z_m", "charge_c"};
  const std::string shown = file == "-" ? "standard input" : file;
  const auto table =
      file == "-"
          ? std::make_unique<CsvTable>(std::cin, shown, std::vector<std::string>(), names)
          : std::make_unique<CsvTable>(file, std::vector<std::string>(), names);
  std::array<std::size_t, 4> place{};
  for (std::size_t c = 0; c < place.size(); ++c) {
    place[c] = table->has(c) ? c : c + place.size();
    if (!table->has(place[c]))
      table->refuse(1, fmt::format("column {} (or {}) is missing from the header", names[c],
                                   names[c + place.size()]));
  }
  Charges c;
  while (table->next_row()) {
    c.x.push_back(table->value(place[0])), c.y.push_back(table->value(place[1]));
    c.z.push_back(table->value(place[2])), c.q.push_back(table->value(place[3]));
  }
  if (c.q.empty()) throw InputError(shown + ": no charges");
  return c;
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024; // Linux counts in KiB
}

double median(std::vector<double> v) {
  std::ranges::sort(v);
  return (v[(v.size() - 1) / 2] + v[v.size() / 2]) / 2;
}

/// If a few charges have nearly all of |F|^2, a tolerance relative to |F| over all charges does
/// not limit the error of the other forces.
void warn_of_the_strongest(ConstVec3View force) {
  constexpr double nearly_all = 0.9;
  std::vector<double> square(force.size());
  for (std::size_t i = 0; i < square.size(); ++i) square[i] = force[i].squaredNorm();
  const std::size_t few = square.size() / 50;
  if (few == 0) return;
  const auto weaker = square.begin() + static_cast<std::ptrdiff_t>(few);
  std::ranges::nth_element(square, weaker, std::greater{});
  const double strong = std::accumulate(square.begin(), weaker, 0.0),
               all = std::accumulate(weaker, square.end(), strong);
  if (strong > nearly_all * all)
    message(
        "ehdjet: {} of {} charges have {:.3g} % of |F|^2, to which the tolerance refers. "
        "The relative error of the force on the others may be larger. --norm per-bead "
        "keeps "
        "the tolerance for each charge\n",
        few, square.size(), 100 * strong / all);
}

std::string json(double number) {
  return std::isfinite(number) ? fmt::format("{:.6g}", number) : "null";
}

/// Compares with the direct sum on some charges, and says what the comparison shows.
CoulombErrorSample checked(const CoulombSolver& solver, const PointCharges& charges,
                           ConstVec3View force) {
  const auto [tolerance, norm] = solver.accuracy();
  const CoulombErrorSample sample = sampled_error(charges, force, norm);
  if (!(sample.in(norm) <= tolerance))
    message("warning: the error of the force, {:.2g}, is above the tolerance {:g}\n",
            sample.in(norm), tolerance);
  if (norm == ToleranceNorm::global) warn_of_the_strongest(force);
  return sample;
}

void forces(const ForcesOptions& options) {
  warn_of_threads(options.threads);
  const ThreadCount threads(options.threads);
  SolverOptions solver_options{.solver = options.solver, .norm = options.norm};
  if (options.tolerance) solver_options.tolerance = *options.tolerance;
  if (!options.calibration.empty())
    solver_options.costs = read_calibration(options.calibration);
  const auto solver = make_coulomb_solver(solver_options);
  const Charges c = read_charges(options.beads);
  std::optional<TextOutput> output; // refuses an existing file before the work
  if (!options.output.empty()) {
    refuse_input(options.output, options.calibration);
    output.emplace(options.output, options.force,
                   options.beads == "-" ? "/dev/stdin" : options.beads);
  }

  const std::size_t n = c.q.size();
  std::vector<double> fx(n), fy(n), fz(n), seconds;
  const Vec3View force{fx, fy, fz};
  for (int i = 0; i < options.repeat; ++i) {
    for (auto* f : {&fx, &fy, &fz}) std::ranges::fill(*f, 0.0);
    const auto start = std::chrono::steady_clock::now();
    solver->add_force({c.positions(), c.q}, force);
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const double peak = peak_mib();
  if (solver->coincident_pairs() > 0)
    message("ehdjet: {} pairs of charges at zero distance were skipped\n",
            solver->coincident_pairs());

  std::string errors; // 0 for the direct sum, which is the reference
  if (options.check) {
    const CoulombErrorSample error = solver->name() == "direct"
                                         ? CoulombErrorSample{}
                                         : checked(*solver, {c.positions(), c.q}, force);
    errors = fmt::format("\"error_l2\":{}, \"error_max\":{}, \"error_of_net_median\":{}, "
                         "\"error_of_net_max\":{}, ",
                         json(error.relative_l2), json(error.worst_per_target),
                         json(error.median_of_net), json(error.worst_of_net));
  }
  if (solver->name() == "auto") message("{}\n", solver->description());
  if (output) {
    output->print("fx,fy,fz\n");
    for (std::size_t i = 0; i < n; ++i)
      output->print("{:.17g},{:.17g},{:.17g}\n", fx[i], fy[i], fz[i]);
    output->close();
    message("forces written to {}\n", options.output);
  }
  print_result("{{\"n\":{}, \"solver\":\"{}\", \"tolerance\":{}, \"threads\":{}, "
               "\"seconds\":{:.9g}, {}\"peak_mib\":{:.1f}}}\n",
               n, solver->name(), options.tolerance.value_or(solver->accuracy().tolerance),
               omp_get_max_threads(), median(seconds), errors, peak);
}

} // namespace

void add_forces_command(CLI::App& app) {
  auto options = std::make_shared<ForcesOptions>();
  std::string solvers;
  for (const SolverDescription& s : coulomb_solvers())
    solvers += fmt::format("{}{}", solvers.empty() ? "" : ", ", s.name);
  CLI::App* command = app.add_subcommand(
      "forces", "Coulomb force on given charges; prints one JSON line on cost and error");
  command
      ->add_option(
          "BEADS", options->beads,
          "CSV with columns x,y,z [m] and q [C], or x_m,y_m,z_m,charge_c as export "
          "writes them, in any order; - reads standard input")
      ->required();
  command->add_option("--solver", options->solver, "How the force is summed: " + solvers)
      ->capture_default_str();
  command
      ->add_option("--tolerance", options->tolerance,
                   "Allowed relative error of the force, from 1e-13 to 0.1; default: 1e-6")
      ->check(finite_number());
  command
      ->add_option("--norm", options->norm,
                   "What the error is relative to: global, |F| over all charges; per-bead, "
                   "the sum of "
                   "the magnitudes of the pair forces on each charge")
      ->check(CLI::Validator(
          [](const std::string& given) {
            return given == "moving"
                       ? "moving needs a jet, in which beads move or rest; here "
                         "all charges are alike: take global or per-bead"
                       : std::string();
          },
          "global or per-bead"))
      ->transform(CLI::CheckedTransformer(std::map<std::string, ToleranceNorm>{
          {"global", ToleranceNorm::global}, {"per-bead", ToleranceNorm::per_bead}}));
  add_calibration_option(*command, options->calibration);
  add_threads_option(*command, options->threads);
  command
      ->add_option("--repeat", options->repeat,
                   "Force calls; their median time is reported")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("-o,--output", options->output,
                      "CSV of forces fx,fy,fz [N], same order");
  command->add_flag("!--no-check", options->check,
                    "Do not compare with the direct sum, which takes longer than the force "
                    "of many charges. Leaves the errors out of the JSON line");
  command->add_flag("--force", options->force, "Overwrite the output if it exists");
  command->callback([options] { forces(*options); });
}

} // namespace ehdjet::cli
