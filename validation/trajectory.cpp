// How does the error of the Coulomb solver carry into what a run computes?
//
// Jets of 20 ms and the growth of a bending wave, with each solver and tolerance, against the
// direct sum at the same rtol. The integrator's own error, rtol 1e-5 against 1e-8, is there for
// comparison. Writes trajectory.csv.

#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "support/bending_wave.hpp"
#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

constexpr double end_time = 0.02, coarse = 1e-5, fine = 1e-8;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Setting {
  std::string solver = "direct";
  std::optional<double> tolerance = {};
  double rtol = coarse;

  [[nodiscard]] std::string text() const {
    return tolerance ? fmt::format("{} {:g}", solver, *tolerance) : solver;
  }
};

std::vector<Setting> settings(const Suite& suite) {
  std::vector<Setting> all{{.rtol = fine}, {.rtol = coarse}};
  const std::vector<double> tolerances = suite.pick<std::vector<double>>(
      {1e-2, 1e-4, 1e-6}, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8});
  for (const std::string solver : {"treecode", "fmm"})
    for (const double tolerance : tolerances) all.push_back({solver, tolerance});
  return all;
}

void apply(const Setting& s, Scene& scene) {
  scene.config.coulomb->solver = s.solver;
  if (s.tolerance) scene.config.coulomb->tolerance = *s.tolerance;
  scene.config.integrator.rtol = s.rtol;
}

struct Measured {
  Run run;
  double growth = none; // of a bending wave [1/s]
  double seconds = 0;
};

/// Scenes, and how to run them.
struct Subject {
  std::string name, scene;
  double cost; // relative
};

Measured measure(const Subject& subject, const Setting& setting) {
  const auto start = std::chrono::steady_clock::now();
  Measured m;
  if (subject.name == "growth") {
    BendingWave wave({10});
    apply(setting, wave.scene());
    m.run = simulate(wave.scene(), wave.time(4));
    m.growth = wave.growth_rate(m.run.jet, 10);
  } else {
    Scene s = scene(subject.scene);
    apply(setting, s);
    m.run = simulate(s, end_time);
  }
  m.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return m;
}

struct Errors {
  double position = none, tip = none, path = none, deposit = none, growth = none;
};

Errors errors(const Measured& m, const Measured& reference) {
  Errors e;
  e.position = largest_distance(m.run.jet, reference.run.jet);
  if (!std::isnan(m.growth)) {
    e.growth = relative(m.growth, reference.growth);
    return e;
  }
  e.tip = relative(m.run.end.tip, reference.run.end.tip);
  e.path = relative(m.run.end.path_length, reference.run.end.path_length);
  e.deposit = relative(m.run.end.deposit_mass, reference.run.end.deposit_mass);
  return e;
}

void study(Suite& suite, Csv& csv, const Subject& subject) {
  const std::vector<Setting> all = settings(suite);
  std::vector<Measured> measured(all.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < all.size(); ++i)
    jobs.emplace_back([&, i] {
      measured[i] = measure(subject, all[i]);
      suite.done(subject.cost, subject.name + " " + all[i].text());
    });
  in_parallel(jobs);

  const Measured &exact = measured[0], &direct = measured[1];
  const Errors own = errors(direct, exact);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Setting& s = all[i];
    const Errors e = i == 1 ? own : errors(measured[i], direct);
    csv.row(subject.name, s.solver, s.tolerance, s.rtol, measured[i].run.jet.time,
            e.position, e.tip, e.path, e.deposit, e.growth,
            measured[i].run.statistics.evaluations, measured[i].seconds);
    if (s.tolerance != 1e-6) continue;
    const std::string name = subject.name + " " + s.text() + " ";
    if (subject.name == "growth") {
      suite.check_at_most(name + "growth rate against the integrator's error", e.growth,
                          own.growth);
      continue;
    }
    suite.check_at_most(name + "path length against the integrator's error", e.path,
                        own.path);
    if (!std::isnan(own.position) && !std::isnan(e.position))
      suite.check_at_most(name + "bead positions against the integrator's error [m]",
                          e.position, own.position);
  }
}

void answer(Suite& suite) {
  Csv csv = suite.csv("trajectory.csv",
                      "scene,solver,tolerance,rtol,time_s,position_error_m,tip_error,"
                      "path_length_error,deposit_mass_error,growth_rate_error,evaluations,"
                      "seconds_s");
  std::vector<Subject> subjects{
      {"growth", "", 0.3}, {"case_one", "table2_none", 1}, {"table2_08", "table2_08", 2}};
  if (suite.full()) {
    subjects.push_back({"table2_04", "table2_04", 4});
    subjects.push_back({"table2_02", "table2_02", 12});
  }
  double cost = 0;
  for (const Subject& s : subjects)
    cost += s.cost * static_cast<double>(settings(suite).size());
  suite.plan(cost);
  for (const Subject& s : subjects) study(suite, csv, s);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "trajectory",
                     "How the Coulomb solver's tolerance carries into a run", answer);
}
