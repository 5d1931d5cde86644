// How far are treecode and fast multipole method from the exact force, and what does a call cost?
//
// Error against time for many sets of charges, against a sum in long double on sampled charges, and
// forces that have a closed form. Writes coulomb.csv, coulomb_closed_forms.csv.

#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <omp.h>

#include <chrono>
#include <map>
#include <optional>
#include <utility>

#include "support/charges.hpp"
#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

using Real = long double;

/// The exact force on some of the charges.
struct Reference {
  std::vector<std::size_t> targets;
  std::vector<Vec3> force;
  std::vector<double> magnitudes; // sum_j |f_ij|
  double rms = 0;                 // of |F_i|
  double cancellation = 0;        // rms of the magnitudes over that of the forces
};

Reference reference(const Charges& c, std::size_t most_targets) {
  const std::size_t n = c.size(), count = std::min(n, most_targets);
  Reference ref{.targets = std::vector<std::size_t>(count),
                .force = std::vector<Vec3>(count),
                .magnitudes = std::vector<double>(count)};
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t i = count == n ? t : (t * (n - 1)) / (count - 1);
    Real fx = 0, fy = 0, fz = 0, magnitude = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const Real dx = Real{c.x[i]} - c.x[j], dy = Real{c.y[i]} - c.y[j],
                 dz = Real{c.z[i]} - c.z[j], square = dx * dx + dy * dy + dz * dz;
      if (square == 0) continue;
      const Real f = Real{constants::coulomb} * c.q[i] * c.q[j] / square;
      const Real over = f / std::sqrt(square);
      fx += over * dx, fy += over * dy, fz += over * dz, magnitude += std::abs(f);
    }
    ref.targets[t] = i;
    ref.force[t] = Vec3(double(fx), double(fy), double(fz));
    ref.magnitudes[t] = double(magnitude);
  }
  double squares = 0, magnitudes = 0;
  for (std::size_t t = 0; t < count; ++t) {
    squares += ref.force[t].squaredNorm();
    magnitudes += ref.magnitudes[t] * ref.magnitudes[t];
  }
  ref.rms = std::sqrt(squares / static_cast<double>(count));
  ref.cancellation = std::sqrt(magnitudes / squares);
  return ref;
}

struct Errors {
  double l2 = 0, largest = 0, per_bead = 0;
};

Errors errors(const Reference& ref, ConstVec3View force) {
  Errors e;
  double squares = 0;
  for (std::size_t t = 0; t < ref.targets.size(); ++t) {
    const double off = (force[ref.targets[t]] - ref.force[t]).norm();
    squares += off * off;
    e.largest = std::max(e.largest, off / ref.rms);
    e.per_bead = std::max(e.per_bead, off / ref.magnitudes[t]);
  }
  e.l2 = std::sqrt(squares / static_cast<double>(ref.targets.size())) / ref.rms;
  return e;
}

struct Force {
  explicit Force(std::size_t n)
      : x(n)
      , y(n)
      , z(n) {}
  Vec3View view() { return {x, y, z}; }
  void clear() {
    for (const auto column : {&x, &y, &z}) std::ranges::fill(*column, 0.0);
  }
  std::vector<double> x, y, z;
};

/// The shortest time of several calls; a single one if it takes long [s].
double time_calls(CoulombSolver& solver, const Charges& c, Force& force, double at_least) {
  using Clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity(), spent = 0;
  for (int call = 0; spent < at_least || (call < 2 && spent < 1); ++call) {
    force.clear();
    const auto start = Clock::now();
    solver.add_force({c.r(), c.q}, force.view());
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, time), spent += time;
  }
  return best;
}

/// A stationary refined jet as the program computes it, to be cut to any number of links.
class RealJet {
public:
  explicit RealJet(const Suite& suite)
      : jet_(simulate(scene(suite.pick("table2_08", "table2_02")), suite.pick(0.012, 0.02))
                 .jet) {}

  [[nodiscard]] std::size_t fewest() const { return jet_.links(); }
  [[nodiscard]] Charges cut(std::size_t n) const {
    JetState jet = jet_;
    const double length = path_length(std::as_const(jet).columns().position());
    RefinementRule rule;
    rule.length = length / static_cast<double>(n);
    refine_jet(jet, rule);
    const auto r = std::as_const(jet).columns().position();
    Charges c;
    for (std::size_t k = 0; k < jet.beads(); ++k)
      if (k != 1 || !jet.has_embryo) c.add(r[k], jet.charge[k]);
    return c;
  }

private:
  JetState jet_;
};

struct Sizes {
  std::vector<std::size_t> charges;
  std::size_t most_direct, most_treecode;
};

class Survey {
public:
  explicit Survey(Suite& suite)
      : suite_(suite)
      , csv_(
            suite.csv("coulomb.csv",
                      "geometry,distribution,charges,solver,tolerance,norm,threads,"
                      "seconds_s,error_l2,error_max,error_per_bead,error_over_tolerance")) {
  }

  void measure(const std::string& geometry, const std::string& distribution,
               const Charges& c, ToleranceNorm norm, const std::vector<double>& tolerances,
               const std::vector<int>& threads) {
    const Reference ref =
        reference(c, std::clamp<std::size_t>(100'000'000 / c.size(), 400, 10'000));
    Force force(c.size());
    for (const std::string solver : {"direct", "treecode", "fmm"}) {
      const bool direct = solver == "direct";
      if (c.size() > (direct ? sizes().most_direct : sizes().most_treecode)
          && solver != "fmm")
        continue;
      for (const double tolerance : direct ? std::vector{0.0} : tolerances)
        for (const int p : threads)
          row({geometry, distribution, solver, direct ? std::optional<double>{} : tolerance,
               norm, p},
              c, ref, force);
    }
  }

  [[nodiscard]] Sizes sizes() const {
    if (suite_.quick())
      return {
          .charges = {150, 1123, 10'000}, .most_direct = 11'000, .most_treecode = 11'000};
    return {.charges = {150, 500, 1123, 3000, 10'000, 30'000, 100'000, 1'000'000},
            .most_direct = 110'000,
            .most_treecode = 110'000};
  }

  /// Errors over tolerances from 1e-2 to 1e-10, less what round-off alone may do.
  void check() {
    for (const auto& [name, worst] : worst_)
      suite_.check_at_most(name, worst,
                           name.starts_with("ring 1e-2") ? 3
                           : name.starts_with("ring ")   ? 1.2
                                                         : 2);
  }

private:
  struct Key {
    std::string geometry, distribution, solver;
    std::optional<double> tolerance;
    ToleranceNorm norm;
    int threads;
  };

  void row(const Key& k, const Charges& c, const Reference& ref, Force& force) {
    const int all = omp_get_max_threads();
    omp_set_num_threads(k.threads);
    const auto solver = make_coulomb_solver(
        {.solver = k.solver, .tolerance = k.tolerance.value_or(1e-6), .norm = k.norm});
    const double time = time_calls(*solver, c, force, suite_.pick(0.01, 0.1));
    omp_set_num_threads(all);
    const Errors e = errors(ref, force.view());
    const bool global = k.norm == ToleranceNorm::global;
    const double error = global ? e.l2 : e.per_bead;
    std::optional<double> ratio;
    if (k.tolerance) {
      ratio = error / *k.tolerance;
      remember(k, (error - round_off * (global ? ref.cancellation : 1)) / *k.tolerance);
    }
    csv_.row(k.geometry, k.distribution, c.size(), k.solver, k.tolerance,
             global ? "global" : "per-bead", k.threads, time, e.l2, e.largest, e.per_bead,
             ratio);
  }

  void remember(const Key& k, double ratio) {
    if (*k.tolerance < 0.9e-10) return;
    const char* part = k.geometry != "ring"    ? ""
                       : *k.tolerance > 0.9e-2 ? " 1e-2"
                                               : " below 1e-2";
    double& worst = worst_[k.geometry + part + " " + k.distribution + " " + k.solver
                           + " error over tolerance"];
    worst = std::max(worst, ratio);
  }

  static constexpr double round_off = 1e-14; // of the direct sum, per sum of magnitudes

  Suite& suite_;
  Csv csv_;
  std::map<std::string, double> worst_;
};

void survey(Suite& suite) {
  Survey survey(suite);
  const RealJet real(suite);
  suite.done(2, "a jet to be cut");
  using Make = std::function<Charges(std::size_t)>;
  const std::vector<std::pair<std::string, Make>> geometries{
      {"jet", jet},   {"line", line},
      {"ring", ring}, {"helix", helix},
      {"cube", cube}, {"real", [&](std::size_t n) { return real.cut(n); }}};
  const std::vector<double> tolerances = suite.pick<std::vector<double>>(
      {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12},
      {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12});
  const std::vector<double> few_tolerances{1e-2, 1e-3, 1e-6, 1e-9}; // of a million
  const std::vector<int> all_threads =
      omp_get_num_procs() > 1 ? std::vector{1, 2} : std::vector{1};
  for (const auto& [name, make] : geometries)
    for (const std::size_t n : survey.sizes().charges) {
      if (name == "real" && n < real.fewest()) continue;
      Charges c = make(n);
      const bool modulated = name == "jet" || name == "line" || name == "helix";
      if (modulated) distribute(c, "modulated");
      survey.measure(name, modulated ? "modulated" : "uniform", c, ToleranceNorm::global,
                     n == 1'000'000 ? few_tolerances : tolerances,
                     suite.full() && n >= 10'000 ? all_threads : std::vector{1});
      suite.done(n < 1'000'000 ? 3 : 10, fmt::format("{} {}", name, n));
    }
  const std::size_t n = suite.pick<std::size_t>(3000, 30'000);
  for (const std::string distribution : {"uniform", "alternating", "decades"})
    for (const auto norm : {ToleranceNorm::global, ToleranceNorm::per_bead}) {
      Charges c = jet(n);
      distribute(c, distribution);
      survey.measure("jet", distribution, c, norm, {1e-3, 1e-6, 1e-9}, {1});
      suite.done(1, "jet " + distribution);
    }
  survey.check();
}

/// Forces by closed forms, in units of q^2/R^2 (ring), q^2/l^2 (line) or newtons (helix).
struct ClosedForm {
  std::string name;
  Charges charges;
  double exact;
  std::function<double(ConstVec3View)> value;
};

// F = q^2/(4 R^2) sum_k 1/sin(pi k/N) on every charge, outwards.
ClosedForm ring_form(std::size_t n) {
  Real sum = 0;
  for (std::size_t k = 1; k < n; ++k)
    sum +=
        1
        / std::sin(std::numbers::pi_v<Real> * static_cast<Real>(k) / static_cast<Real>(n));
  const Charges c = ring(n);
  const double unit = constants::coulomb * c.q[0] * c.q[0] / (ring_radius * ring_radius);
  return {"ring", c, double(sum / 4), [c, unit](ConstVec3View f) {
            Real outwards = 0;
            for (std::size_t i = 0; i < c.size(); ++i)
              outwards += f[i].dot(c.r()[i]) / ring_radius;
            return double(outwards / static_cast<Real>(c.size())) / unit;
          }};
}

// F_end = q^2/l^2 sum_(k < N) 1/k^2.
ClosedForm line_form(std::size_t n) {
  Real sum = 0;
  for (std::size_t k = n - 1; k > 0; --k)
    sum += 1 / (static_cast<Real>(k) * static_cast<Real>(k));
  const Charges c = line(n);
  const double link = 0.16 / static_cast<double>(n - 1);
  const double unit = constants::coulomb * c.q[0] * c.q[0] / (link * link);
  return {"line", c, double(sum), [unit](ConstVec3View f) { return -f.x[0] / unit; }};
}

// All neighbours of the first charge, by their turn and rise.
ClosedForm helix_form(std::size_t n) {
  const Charges c = helix(n);
  const Helix h{n};
  const Real a = h.radius, turn = h.turn(), rise = h.rise();
  Real fx = 0, fy = 0, fz = 0;
  for (std::size_t k = n - 1; k > 0; --k) {
    const auto m = static_cast<Real>(k);
    const Real chord = 2 * a * std::sin(turn * m / 2),
               square = chord * chord + rise * m * rise * m,
               cube = square * std::sqrt(square);
    fx += -rise * m / cube, fy += chord * std::sin(turn * m / 2) / cube;
    fz += -a * std::sin(turn * m) / cube;
  }
  const Real unit = Real{constants::coulomb} * c.q[0] * c.q[0];
  const double exact = double(unit * std::sqrt(fx * fx + fy * fy + fz * fz));
  return {"helix", c, exact, [](ConstVec3View f) { return f[0].norm(); }};
}

void closed_forms(Suite& suite) {
  Csv csv = suite.csv("coulomb_closed_forms.csv",
                      "case,charges,solver,tolerance,value,exact,relative_error");
  std::map<std::string, double> worst;
  const std::vector<std::size_t> sizes = suite.pick<std::vector<std::size_t>>(
      {100, 1000, 10'000, 100'000}, {100, 1000, 10'000, 100'000, 1'000'000});
  for (const std::size_t n : sizes)
    for (const auto make : {ring_form, line_form, helix_form}) {
      const ClosedForm form = make(n);
      Force force(n);
      const auto measure = [&](const std::string& solver, std::optional<double> tolerance) {
        force.clear();
        make_coulomb_solver({.solver = solver, .tolerance = tolerance.value_or(1e-6)})
            ->add_force({form.charges.r(), form.charges.q}, force.view());
        const double value = form.value(force.view());
        const double error = relative(value, form.exact);
        csv.row(form.name, n, solver, tolerance, value, form.exact, error);
        double& w = worst[form.name + " " + solver];
        w = std::max(w, tolerance ? error / *tolerance : error);
      };
      if (n <= suite.pick<std::size_t>(10'000, 100'000)) measure("direct", {});
      for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        if (n <= 100'000) measure("treecode", tolerance);
        measure("fmm", tolerance);
      }
      suite.done(n < 1'000'000 ? 1 : 10, form.name + " in closed form");
    }
  for (const auto& [name, value] : worst)
    if (name.ends_with("direct"))
      suite.check_at_most(name + " closed form", value, 1e-12);
    else
      suite.check_at_most(name + " closed form error over tolerance", value, 2);
}

void answer(Suite& suite) {
  suite.plan(suite.pick(2 + 6 * 3 * 3 + 6 + 12., 2 + 6 * (7 * 3 + 10) + 6 + 3 * (4 + 10.)));
  survey(suite);
  closed_forms(suite);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "coulomb",
                     "Accuracy and cost of the Coulomb solvers, and forces in closed form",
                     answer);
}
