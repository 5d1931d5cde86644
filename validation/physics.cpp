// Does the jet move as closed forms, independent computations and published runs say?
//
// Writes physics.csv, dispersion.csv, energy.csv. The reference numbers were not computed with this
// project; `source` says where they come from.

#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "support/bending_wave.hpp"
#include "support/energy_budget.hpp"
#include "support/jets.hpp"
#include "support/scenes.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;
using namespace ehdjet::test;

/// physics.csv. Every row is a check.
class Comparison {
public:
  explicit Comparison(Suite& suite)
      : suite_(suite)
      , csv_(suite.csv("physics.csv", "check,value,reference,relative_difference,bound,"
                                      "passed,source")) {}

  void add(const std::string& check, double value, double reference, double bound,
           const std::string& source) {
    add_difference(check, value, reference, std::abs(value / reference - 1), bound, source);
  }
  /// For a quantity with a scale of its own.
  void add_difference(const std::string& check, double value, double reference,
                      double difference, double bound, const std::string& source) {
    csv_.row(check, value, reference, difference, bound, int{difference <= bound}, source);
    suite_.check_at_most(check, difference, bound);
  }

private:
  Suite& suite_;
  Csv csv_;
};

// --- closed forms

void pair_force(Comparison& c) {
  const std::array x{0.0, 2e-4}, zero{0.0, 0.0}, q{1e-9, 2e-9};
  std::array<double, 2> fx{}, fy{}, fz{};
  make_coulomb_solver({.solver = "direct"})->add_force({{x, zero, zero}, q}, {fx, fy, fz});
  c.add("force between 1 nC and 2 nC 0.2 mm apart [N]", fx[1], 0.449377589368409, 1e-14,
        "Coulomb's law");
}

// t(x) = sqrt(mu r0^3/(2 k q^2)) (sqrt(x(x-1)) + arccosh sqrt x), mu the reduced mass
void two_bodies(Comparison& c) {
  struct Row {
    double ratio, growth, time;
  };
  for (const auto& [ratio, growth, time] :
       {Row{1, 2, 5.39315316974245e-5}, Row{1, 10, 2.656013458751696e-4},
        Row{1, 100, 2.407901936788273e-3}, Row{10, 2, 7.272126250567114e-5},
        Row{10, 10, 3.581367817181825e-4}}) {
    Scene s = chain_scene();
    s.config.coulomb = CoulombConfig{};
    Bead far = pvp_bead({pvp::link_length, 0, 0});
    far.mass *= ratio;
    add_bead(s, pvp_bead(Vec3::Zero())), add_bead(s, far);
    const auto simulation = run(s, time);
    const auto r = simulation->jet().columns().position();
    c.add(fmt::format("two charges of mass ratio {:g}: distance at {:.4g} s", ratio, time),
          (r[1] - r[0]).norm() / pvp::link_length, growth, 1e-9,
          "closed form of two repelling bodies");
  }
}

// Groups Q = F = 12, V = 2; JETSPIN's first example, ten digits printed.
void start_up(Comparison& c) {
  const Scene s = scene("startup");
  const auto simulation = run(s, s.config.run.end_time);
  const auto columns = simulation->jet().columns();
  const double length = 0.319 * cm, tau = 0.01;
  const std::string source = "JETSPIN 1.00 example 1: shipped log";
  c.add("start-up of a jet: length at 10 tau", columns.position()[1].x() / length,
        95.85942443, 1e-9, source);
  c.add("start-up of a jet: speed at 10 tau", columns.velocity()[1].x() * tau / length,
        18.65420366, 1e-9, source);
  c.add("start-up of a jet: stress at 10 tau", stress_of(columns)[1] / 1e3, 0.2155019712,
        1e-9, source);
}

void insertion_times(Comparison& c) {
  struct Row {
    bool gravity;
    double insertion, release;
  };
  for (const auto& [gravity, insertion, release] :
       {Row{false, 5.1019218390e-5, 7.4996532673e-5},
        Row{true, 5.1015906424e-5, 7.4991241052e-5}}) {
    Scene s = case_one("dop853", 1e-12);
    s.config.nozzle->amplitude = 0;
    s.config.surface_tension.reset();
    if (!gravity) s.config.gravity.reset();
    const auto simulation = build_simulation(s);
    double inserted = 0, released = 0;
    simulation->after_each_step([&](const Simulation& now) {
      if (inserted == 0 && now.statistics().insertions == 1) inserted = now.jet().time;
      if (released == 0 && now.statistics().releases == 1) released = now.jet().time;
    });
    simulation->run_until(8e-5);
    const char* with = gravity ? "with" : "without";
    const std::string source = "independent 8th-order integration";
    c.add(fmt::format("first insertion {} gravity [s]", with), inserted, insertion, 1e-9,
          source);
    c.add(fmt::format("first release {} gravity [s]", with), released, release, 1e-9,
          source);
  }
}

// --- independent computations

void golden_chains(Comparison& c) {
  for (const std::string kind : {"free", "held"}) {
    GoldenChain golden(kind);
    integrate(golden.scene, "dop853", 1e-12);
    double worst = 0;
    for (std::size_t i = 1; i < golden.times(); ++i) {
      const auto simulation = run(golden.scene, golden.time(i));
      for (std::size_t k = 0; k < golden.size(); ++k)
        worst = std::max(
            worst,
            (simulation->jet().columns().position()[k] - golden.position(i, k)).norm());
    }
    c.add_difference(fmt::format("golden chain ({}): largest distance of a bead [m]", kind),
                     worst, 0, worst / pvp::link_length, 1e-11,
                     "independent 8th-order integration");
  }
}

double distance(const JetState& jet, const Table& reference) {
  if (jet.beads() != reference.rows()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    const Vec3 r =
        cm
        * Vec3(reference.at(k, "x_cm"), reference.at(k, "y_cm"), reference.at(k, "z_cm"));
    worst = std::max(worst, (jet.columns().position()[k] - r).norm());
  }
  return worst;
}

// Its errors: below 2e-8 cm to 5 ms, then growing to 1e-6 relative at 20 ms.
void case_one_states(Comparison& c) {
  const auto simulation = build_simulation(case_one("dop853", 1e-10));
  for (const int us : {1000, 2000, 5000, 10000, 20000}) {
    simulation->run_until(1e-6 * us);
    const double off =
        distance(simulation->jet(), Table(fmt::format("case_one/state_t{:05}us.csv", us)));
    const double length = path_length(simulation->jet().columns().position());
    c.add_difference(
        fmt::format("case I at {} ms: largest distance of a bead [m]", us / 1000), off, 0,
        off / length, us <= 5000 ? 1e-8 : 1e-6, "independent implementation in Python");
  }
}

// --- published runs

struct Stationary {
  Sample mean;
  double impact = 0, radius_landing = 0, radius_removal = 0; // [m/s], [m]
  double release_speed = 0;                                  // [m/s]
};

class Landings final : public Observer {
public:
  Landings(double from, std::vector<DepositedBead>& beads)
      : from_(from)
      , beads_(beads) {}
  void deposit(const DepositedBead& bead) override {
    if (bead.time >= from_) beads_.push_back(bead);
  }

private:
  double from_;
  std::vector<DepositedBead>& beads_;
};

Stationary stationary_case_one(double from, double to) {
  const auto simulation = build_simulation(scene("table2_none"));
  std::vector<Sample> samples;
  std::vector<DepositedBead> landed;
  double release_speed = 0, looks = 0;
  simulation->add(
      std::make_unique<validation::Watch>(1e-5, [&](const JetSnapshot& snapshot) {
        samples.push_back(sample_of(snapshot));
        if (snapshot.time < from) return;
        release_speed += snapshot.ledger.release_speed, ++looks;
      }));
  simulation->add(std::make_unique<Landings>(from, landed));
  simulation->run_until(to);
  Stationary s{.mean = mean(samples, from, to), .release_speed = release_speed / looks};
  const auto n = static_cast<double>(landed.size());
  for (const DepositedBead& bead : landed) {
    s.impact += bead.bead.velocity.norm() / n;
    s.radius_landing += bead.landing_radius / n, s.radius_removal += bead.radius / n;
  }
  return s;
}

void stationary_values(Suite& suite, Comparison& c) {
  const Stationary s = stationary_case_one(0.035, suite.pick(0.05, 0.1));
  const std::string own = "converged in time: two independent implementations",
                    jetspin = "JETSPIN 1.20 example 3: shipped log";
  const double bound = 1e-3;
  c.add("case I: beads", s.mean.beads, 149.58, bound, own);
  c.add("case I: tip from the axis [m]", s.mean.tip, 4.4558e-2, bound, own);
  c.add("case I: path length [m]", s.mean.path_length, 2.1801, bound, own);
  c.add("case I: impact speed [m/s]", s.impact, 20.923, bound, own);
  c.add("case I: radius of a link at its landing [m]", s.radius_landing, 3.8945e-6, bound,
        own);
  c.add("case I: radius of a link at its removal [m]", s.radius_removal, 3.8888e-6, bound,
        own);
  c.add("case I: beads: JETSPIN's", s.mean.beads, 149.56, bound, jetspin);
  c.add("case I: tip from the axis: JETSPIN's [m]", s.mean.tip, 4.4553e-2, bound, jetspin);
  c.add("case I: path length: JETSPIN's [m]", s.mean.path_length, 2.18, bound, jetspin);
  c.add("case I: impact speed: JETSPIN's [m/s]", s.impact, 20.927, bound, jetspin);
  c.add("case I: release speed: JETSPIN's [m/s]", s.release_speed, 2.21143, bound, jetspin);
  c.add("case I: radius at the collector: JETSPIN's [m]", s.radius_removal, 3.8892e-6,
        bound, jetspin);
  c.add("case I: beads: the paper's", s.mean.beads, 150, 5e-3, "paper: Table 2");
}

// --- dispersion

void dispersion(Suite& suite) {
  Csv csv = suite.csv("dispersion.csv", "wavelength_m,solver,tolerance,growth_rate_per_s,"
                                        "theory_per_s,relative_error");
  struct Solver {
    std::string name;
    std::optional<double> tolerance = {};
  };
  std::vector<Solver> solvers{{"direct"}, {"treecode", 1e-6}, {"fmm", 1e-6}};
  if (suite.full())
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-8})
      for (const std::string solver : {"treecode", "fmm"})
        solvers.push_back({solver, tolerance});
  const std::vector<double> wavelengths{2, 4, 10, 20, 50};
  for (const Solver& solver : solvers) {
    BendingWave wave(wavelengths);
    integrate(wave.scene(), "dop853", 1e-12); // of a link: waves start at 1e-7 of it
    wave.scene().config.coulomb->solver = solver.name;
    if (solver.tolerance) wave.scene().config.coulomb->tolerance = *solver.tolerance;
    const Run result = simulate(wave.scene(), wave.time(4));
    double worst = 0, sideways = 0;
    for (const double n : wavelengths) {
      const double measured = wave.growth_rate(result.jet, n), theory = wave.theory(n);
      csv.row(n * wave.link_length(), solver.name, solver.tolerance, measured, theory,
              relative(measured, theory));
      worst = std::max(worst, relative(measured, theory));
    }
    for (const double z : result.jet.columns().position().z)
      sideways = std::max(sideways, std::abs(z));
    if (!solver.tolerance || *solver.tolerance <= 1e-6) {
      const std::string name = solver.tolerance
                                   ? fmt::format("{} {:g}", solver.name, *solver.tolerance)
                                   : solver.name;
      suite.check_at_most("growth rates of bending waves " + name, worst, 1e-3);
    }
    if (!solver.tolerance)
      suite.check_at_most("a plane bending wave leaves its plane [m]", sideways, 0);
    suite.done(1, "growth of bending waves, " + solver.name);
  }
}

// --- energy

struct EnergySetting {
  std::string method;
  double rtol;
  std::string solver = "direct";
  std::optional<double> tolerance = {};

  [[nodiscard]] std::string text() const {
    return fmt::format("{} {:g} {}{}", method, rtol, solver,
                       tolerance ? fmt::format(" {:g}", *tolerance) : "");
  }
};

/// The golden zig-zag, long enough for a cluster tree.
Scene long_zigzag(std::size_t beads) {
  Scene s = GoldenChain("free").scene;
  s.chain = {};
  for (std::size_t k = 0; k < beads; ++k) {
    const auto j = static_cast<double>(k);
    const double l = pvp::link_length;
    add_bead(s, pvp_bead({j * l, k == 0 ? 0 : 0.1 * l * std::sin(j),
                          0.1 * l * (std::cos(j) - 1)}));
  }
  return s;
}

/// Largest change over the Coulomb energy at the start.
double energy_residual(Csv& csv, const std::string& name, const Scene& scene,
                       const EnergySetting& s, const std::vector<double>& times) {
  BudgetedChain chain(
      scene, {s.method, s.rtol,
              CoulombConfig{.solver = s.solver, .tolerance = s.tolerance.value_or(1e-6)}});
  const ChainBudget start = chain.budget_at(0);
  double worst = 0;
  for (const double t : times) {
    const ChainBudget b = chain.budget_at(t);
    const double residual =
        std::abs(b.stored() - start.stored() + b.dissipated - b.work) / start.coulomb;
    csv.row(name, s.method, s.rtol, s.solver, s.tolerance, t, residual);
    worst = std::max(worst, residual);
  }
  return worst;
}

void energy(Suite& suite) {
  Csv csv = suite.csv("energy.csv", "scene,method,rtol,solver,tolerance,time_s,residual");
  const std::vector<double> times{1e-5, 1e-4, 2e-4};
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12})
    for (const std::string method : {"dormand-prince", "dop853"})
      for (const std::string kind : {"free", "held"}) {
        const EnergySetting s{method, rtol};
        const double worst =
            energy_residual(csv, "golden " + kind, GoldenChain(kind).scene, s, times);
        suite.check_at_most(fmt::format("energy residual golden {} {}", kind, s.text()),
                            worst, rtol);
      }
  suite.done(1, "energy of golden chains");
  const Scene zigzag = long_zigzag(suite.pick<std::size_t>(400, 2000));
  std::vector<EnergySetting> settings{{"dop853", 1e-11}};
  for (const double tolerance : {1e-3, 1e-6, 1e-9})
    for (const std::string solver : {"treecode", "fmm"})
      settings.push_back({"dop853", 1e-11, solver, tolerance});
  for (const EnergySetting& s : settings)
    suite.check_at_most("energy residual zig-zag " + s.text(),
                        energy_residual(csv, "zig-zag", zigzag, s, times),
                        s.tolerance.value_or(1e-11));
  suite.done(suite.pick(1, 4), "energy of a zig-zag");
}

void answer(Suite& suite) {
  suite.plan(suite.pick(1 + 1 + 1 + 2 + 4 + 3, 1 + 1 + 4 + 2 + 9 + 11));
  Comparison c(suite);
  pair_force(c);
  two_bodies(c);
  start_up(c);
  insertion_times(c);
  golden_chains(c);
  suite.done(1, "closed forms");
  energy(suite);
  case_one_states(c);
  suite.done(2, "case I against reference states");
  stationary_values(suite, c);
  suite.done(suite.pick(4, 9), "case I, stationary");
  dispersion(suite);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "physics",
                     "Closed forms, independent computations and published runs", answer);
}
