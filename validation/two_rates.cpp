// What do steps with two rates save, and at which error?
//
// The jets of the paper's Table 2 and finer ones, with one rate and with two at the same tolerance,
// against a run at a tighter one; the growth of the cost with the number of beads; stiff fluids.
// Writes two_rates.csv, two_rates_stiff.csv.

#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

constexpr double rtol = 1e-5;

/// Links per refinement length [m], and what a millisecond may cost with two rates.
struct Length {
  double length;    // L~ [m], 0: none
  double full_sums; // at most, per millisecond
  double seconds;   // of all its runs, for the progress
};
constexpr Length lengths[] = {{0, 150, 1},       {0.008, 95, 2},   {0.004, 60, 6},
                              {0.002, 55, 25},   {0.001, 60, 150}, {0.0005, 130, 90},
                              {0.0002, 250, 400}};

Scene jet(double length, const std::string& method, double tolerance) {
  Scene s = scene(length > 0 ? "table2_02" : "table2_none");
  if (length > 0) {
    s.config.refinement->length = length;
    NozzleConfig& nozzle =
        *s.config.nozzle; // links that are cut are longer than those that are born
    nozzle.link_length = std::min(nozzle.link_length, length / 2);
    s.config.refinement->remap = LinkRemap::conservative;
  }
  s.config.coulomb->solver = "auto", s.config.coulomb->tolerance = 1e-6;
  s.config.integrator.method = method, s.config.integrator.rtol = tolerance;
  return s;
}

/// A run and what the stationary part of it has cost per millisecond.
struct Measured {
  JetState jet;
  Sample end;
  double beads = 0, seconds = 0, evaluations = 0, inner_evaluations = 0, full_sums = 0;
};

Measured measure(const Scene& scene, double from, double to) {
  using Clock = std::chrono::steady_clock;
  const auto simulation = build_simulation(scene);
  simulation->run_until(from);
  const RunStatistics a = simulation->statistics();
  const auto beads = static_cast<double>(simulation->jet().links());
  const auto start = Clock::now();
  simulation->run_until(to);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const RunStatistics& b = simulation->statistics();
  const double ms = 1e3 * (to - from);
  Measured m{.jet = simulation->jet(),
             .end = sample_of({to, simulation->jet().columns(), simulation->jet(),
                               simulation->ledger(), b})};
  m.beads = (beads + m.end.beads) / 2;
  m.seconds = seconds / ms;
  m.evaluations = static_cast<double>(b.evaluations - a.evaluations) / ms;
  m.full_sums = m.evaluations;
  if (b.two_rates) {
    m.inner_evaluations =
        static_cast<double>(b.two_rates->inner_evaluations - a.two_rates->inner_evaluations)
        / ms;
    m.full_sums = (b.two_rates->full_sums - a.two_rates->full_sums) / ms;
  }
  return m;
}

class Answer {
public:
  explicit Answer(Suite& suite)
      : suite_(suite)
      , csv_(suite.csv(
            "two_rates.csv",
            "length_m,method,rtol,beads,evaluations_per_ms,inner_evaluations_per_ms,"
            "full_sums_per_ms,seconds_per_ms_s,error_m,tip_error,path_length_error")) {}

  void run() {
    const std::size_t number = suite_.pick<std::size_t>(3, 7);
    double cost = 5;
    for (std::size_t i = 0; i < number; ++i) cost += lengths[i].seconds;
    suite_.plan(cost);
    for (std::size_t i = 0; i < number; ++i) compare(lengths[i]);
    if (suite_.full()) check_growth();
    stiff();
    suite_.done(5, "stiff fluids");
  }

private:
  // At 0.5 mm and below a run with one rate at a tighter tolerance would take hours. There the reference
  // has two rates, and finer steps of both.
  void compare(const Length& row) {
    const bool fine = row.length > 0 && row.length < 0.002;
    const double from = suite_.pick(0.012, 0.015),
                 to = suite_.pick(0.014, fine ? 0.016 : 0.02);
    const Measured exact =
        measure(jet(row.length, fine ? "two-rate" : "dormand-prince", fine ? 1e-7 : 1e-8),
                from, to);
    const Measured one = measure(jet(row.length, "dormand-prince", rtol), from, to);
    const Measured two = measure(jet(row.length, "two-rate", rtol), from, to);
    const double error_one = write(row, "dormand-prince", one, exact),
                 error_two = write(row, "two-rate", two, exact);
    two_.push_back(two);
    const std::string name =
        row.length > 0 ? fmt::format("{} cm", 100 * row.length) : "none";
    suite_.check_at_most(name + ": Coulomb sums per ms", two.full_sums, row.full_sums);
    suite_.check_at_most(name + ": tip", relative(two.end.tip, exact.end.tip), 1e-3);
    suite_.check_at_most(name + ": path length",
                         relative(two.end.path_length, exact.end.path_length), 1e-3);
    // A mesh is cut at a threshold: a rounding may cut one link more, and then all differ.
    if (std::isfinite(error_one) && std::isfinite(error_two) && error_one < 1e-4)
      suite_.check_at_most(name + ": worst bead over that with one rate",
                           error_two / error_one, fine ? 2 : 1.3);
    if (row.length > 0)
      suite_.check_at_least(name + ": gain in time", one.seconds / two.seconds, 1);
    suite_.done(row.seconds, name);
  }

  double write(const Length& row, const std::string& method, const Measured& m,
               const Measured& exact) {
    const double error = largest_distance(m.jet, exact.jet);
    csv_.row(row.length, method, rtol, m.beads, m.evaluations, m.inner_evaluations,
             m.full_sums, m.seconds, error, relative(m.end.tip, exact.end.tip),
             relative(m.end.path_length, exact.end.path_length));
    return error;
  }

  /// Exponent of the time in the number of beads, from 0.2 cm on.
  void check_growth() {
    const auto exponent = [](const std::vector<Measured>& rows) {
      return std::log(rows.back().seconds / rows[3].seconds)
             / std::log(rows.back().beads / rows[3].beads);
    };
    suite_.check_at_most("exponent of the time with two rates", exponent(two_), 2.1);
  }

  // A hundred times stiffer, and with a fortieth of the viscosity: all beads are faster then.
  void stiff() {
    Csv csv =
        suite_.csv("two_rates_stiff.csv",
                   "elastic_modulus_Pa,viscosity_Pa_s,method,evaluations_per_ms,"
                   "inner_evaluations_per_ms,full_sums_per_ms,seconds_per_ms_s,error_m");
    const double from = 0.012, to = suite_.pick(0.014, 0.02);
    const std::pair<double, double> fluids[] = {{5e3, 2}, {5e5, 2}, {5e3, 0.05}, {5e3, 20}};
    for (const auto& given : fluids) {
      const double modulus = given.first, viscosity = given.second;
      const auto fluid = [&](const std::string& method, double tolerance) {
        Scene s = jet(0.004, method, tolerance);
        s.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
        return measure(s, from, to);
      };
      const Measured exact = fluid("dormand-prince", 1e-8);
      const Measured runs[] = {fluid("dormand-prince", rtol), fluid("two-rate", rtol)};
      for (std::size_t i = 0; i < 2; ++i)
        csv.row(modulus, viscosity, i == 0 ? "dormand-prince" : "two-rate",
                runs[i].evaluations, runs[i].inner_evaluations, runs[i].full_sums,
                runs[i].seconds, largest_distance(runs[i].jet, exact.jet));
      suite_.check_at_least(
          fmt::format("G {} Pa and mu {} Pa s: gain in sums", modulus, viscosity),
          runs[0].full_sums / runs[1].full_sums, 2);
    }
  }

  Suite& suite_;
  Csv csv_;
  std::vector<Measured> two_;
};

void answer(Suite& suite) {
  Answer(suite).run();
}

} // namespace

int main(int argc, char** argv) {
  return ehdjet::validation::run_program(
      argc, argv, "two_rates", "What steps with two rates save, and at which error",
      answer);
}
