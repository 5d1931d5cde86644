// Error against run time of the Coulomb solvers: number of charges, geometry, tolerance and
// threads, one CSV row each. bench/plot_coulomb draws it.
//
//   build/release/bench/coulomb_survey [-o survey.csv] [--most 1000000] [--beads jet.csv] ...

#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/scene/calibration_file.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "geometries.hpp"

namespace {

using namespace ehdjet;

struct Options {
  std::string output = "coulomb_survey.csv", beads, calibration;
  std::vector<std::string> geometries{"jet", "line", "ring", "cube"};
  std::vector<std::string> solvers{"direct", "treecode", "fmm"};
  std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12};
  std::vector<int> threads{1};
  std::size_t most = 1'000'000, most_direct = 20'000, most_treecode = 100'000;
  double seconds = 0.3; // spent on a row at least, if a call takes less
};

double best_time(CoulombSolver& solver, const bench::Charges& c, Vec3View force,
                 double at_least) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300, spent = 0;
  for (int call = 0; call < 2 || spent < at_least; ++call) {
    for (const auto column : {force.x, force.y, force.z}) std::ranges::fill(column, 0.0);
    const auto start = Clock::now();
    solver.add_force(c.r(), c.q, force);
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, time), spent += time;
  }
  return best;
}

void survey(const Options& options) {
  std::map<std::string, std::function<bench::Charges(std::size_t)>> make{
      {"jet", bench::jet},
      {"line", bench::line},
      {"ring", bench::ring},
      {"cube", bench::cube}};
  std::vector<std::string> geometries = options.geometries;
  if (!options.beads.empty()) {
    make["real"] = [&](std::size_t n) { return bench::real_jet(options.beads, n); };
    geometries.emplace_back("real");
  }
  std::optional<CostModel> costs;
  if (!options.calibration.empty()) costs = read_calibration(options.calibration);
  std::FILE* out = std::fopen(options.output.c_str(), "wx");
  if (out == nullptr) throw InputError(options.output + " exists or cannot be created");
  fmt::print(out, "geometry,charges,solver,tolerance,threads,seconds,error_l2,error_max,"
                  "error_over_tolerance\n");
  for (const auto& geometry : geometries)
    for (const std::size_t n :
         {150U, 500U, 1123U, 3000U, 10000U, 30000U, 100000U, 1000000U}) {
      if (n > options.most) continue;
      const bench::Charges c = make.at(geometry)(n);
      std::vector<double> fx(c.size()), fy(c.size()), fz(c.size());
      const Vec3View force{fx, fy, fz};
      for (const auto& name : options.solvers) {
        if (name == "direct" && n > options.most_direct) continue;
        if (name == "treecode" && n > options.most_treecode) continue;
        for (const double tolerance : options.tolerances) {
          if (name == "direct" && tolerance != options.tolerances.front()) continue;
          for (const int threads : options.threads) {
            omp_set_num_threads(threads);
            const auto solver = make_coulomb_solver(
                {.solver = name, .tolerance = tolerance, .costs = costs});
            const double time = best_time(*solver, c, force, options.seconds);
            omp_set_num_threads(omp_get_num_procs());
            const auto error = sampled_error(
                c.r(), c.q, force, std::clamp<std::size_t>(20'000'000 / n, 100, 1000));
            const bool direct = name == "direct";
            fmt::print(out, "{},{},{},{},{},{:.4g},{:.3g},{:.3g},{}\n", geometry, c.size(),
                       name, direct ? "" : fmt::format("{:g}", tolerance), threads, time,
                       error.relative_l2, error.worst_per_target,
                       direct ? "" : fmt::format("{:.3g}", error.relative_l2 / tolerance));
            std::fflush(out);
          }
        }
        fmt::print(stderr, "{} {} {}\n", geometry, c.size(), name);
      }
    }
  std::fclose(out);
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Error against run time of the Coulomb solvers"};
  app.add_option("-o,--output", options.output, "CSV file")->capture_default_str();
  app.add_option("--beads", options.beads,
                 "CSV of `ehdjet export --beads`: a real jet as a further geometry");
  app.add_option("--geometries", options.geometries)->delimiter(',')->capture_default_str();
  app.add_option("--solvers", options.solvers)->delimiter(',')->capture_default_str();
  app.add_option("--tolerances", options.tolerances)->delimiter(',')->capture_default_str();
  app.add_option("--threads", options.threads)->delimiter(',')->capture_default_str();
  app.add_option("--most", options.most, "Largest number of charges")
      ->capture_default_str();
  app.add_option("--most-direct", options.most_direct,
                 "Largest number of charges of the direct sum")
      ->capture_default_str();
  app.add_option("--most-treecode", options.most_treecode,
                 "Largest number of charges of the treecode")
      ->capture_default_str();
  app.add_option("--calibration", options.calibration,
                 "File of `ehdjet calibrate`, for the solver \"auto\"");
  app.add_option("--seconds", options.seconds, "Time spent on a row")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    survey(options);
  } catch (const Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return e.exit_code();
  }
  return 0;
}
