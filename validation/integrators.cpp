// What does each Runge-Kutta method reach for how many evaluations, and at what order?
//
// Case I at 5 ms (in full also a refined jet at 15 ms, where beads land) with every method, fixed
// and adaptive steps, events located and snapped to the ends of steps, against Dormand-Prince
// 8(5,3) at a tight tolerance. Writes integrators.csv.

#include "ehdjet/integrators/butcher_tableau.hpp"

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

struct Setting {
  std::string method;
  bool adaptive;
  double value; // rtol, or step [s]
  bool located = true, landings_located = false;

  [[nodiscard]] std::string curve() const {
    return fmt::format("{} {} {}", method, adaptive ? "rtol" : "step",
                       located ? "located" : "step-end");
  }
};

struct Measured {
  Setting setting;
  Run run;
  double error = 0, seconds = 0; // [m], [s]
};

Scene scene_of(const std::string& name, const Setting& s) {
  Scene scene = validation::scene(name);
  IntegratorConfig& c = scene.config.integrator;
  c.method = s.method;
  c.rtol.reset(), c.step.reset();
  (s.adaptive ? c.rtol : c.step) = s.value;
  c.events = s.located ? EventPlacement::located : EventPlacement::step_end;
  c.landings = s.landings_located ? LandingSteps::located : LandingSteps::automatic;
  return scene;
}

/// Steps that halve, from one that is stable and coarse for the method's order.
std::vector<double> steps(const ButcherTableau& method, const Suite& suite) {
  double step = method.order >= 4 ? 2e-5 : method.order == 2 ? 4e-6 : 1e-6; // [s]
  std::vector<double> all;
  for (int i = 0; i < suite.pick(6, 8); ++i, step /= 2) all.push_back(step);
  return all;
}

std::vector<Setting> settings(const Suite& suite) {
  std::vector<Setting> all;
  for (const ButcherTableau& method : butcher_tableaus()) {
    for (const bool located : {true, false})
      for (const double step : steps(method, suite))
        all.push_back({std::string(method.name), false, step, located});
    if (method.error.empty()) continue;
    for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9})
      all.push_back({std::string(method.name), true, rtol});
    if (suite.full())
      for (const double rtol : {1e-3, 1e-5, 1e-7})
        all.push_back({std::string(method.name), true, rtol, false});
  }
  return all;
}

class Study {
public:
  Study(Suite& suite, Csv& csv, std::string name, std::string scene, double end_time,
        double cost)
      : suite_(suite)
      , csv_(csv)
      , name_(std::move(name))
      , scene_(std::move(scene))
      , end_time_(end_time)
      , cost_(cost) {}

  std::vector<Measured> run(const Setting& reference, const std::vector<Setting>& all) {
    Run exact;
    std::vector<Measured> measured(all.size());
    std::vector<std::function<void()>> jobs{[&] {
      exact = simulate(scene_of(scene_, reference), end_time_);
      suite_.done(cost_, name_ + " reference");
    }};
    for (std::size_t i = 0; i < all.size(); ++i)
      jobs.emplace_back([&, i] { measured[i] = measure(all[i]); });
    in_parallel(jobs);
    for (Measured& m : measured) {
      m.error = largest_distance(m.run.jet, exact.jet, scene_ == "table2_none");
      write(m);
    }
    return measured;
  }

private:
  Measured measure(const Setting& s) {
    const auto start = std::chrono::steady_clock::now();
    Measured m{.setting = s, .run = simulate(scene_of(scene_, s), end_time_)};
    m.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    suite_.done(cost_, fmt::format("{} {} {:g}", name_, s.curve(), s.value));
    return m;
  }

  void write(const Measured& m) {
    const Setting& s = m.setting;
    csv_.row(name_, s.method, s.located ? "located" : "step-end",
             s.landings_located ? "located" : "auto", s.adaptive ? "rtol" : "step", s.value,
             m.run.statistics.evaluations, m.run.statistics.steps,
             m.run.statistics.rejected, m.seconds, m.error);
  }

  Suite& suite_;
  Csv& csv_;
  std::string name_, scene_;
  double end_time_, cost_; // [s], relative
};

/// Slope of log(error) over log(step), least squares over the finest steps whose error is well
/// above that of the reference.
double observed_order(const std::vector<Measured>& curve) {
  constexpr double reference_error = 1e-11; // [m]
  constexpr std::size_t points = 4;
  std::vector<const Measured*> finest;
  for (auto m = curve.rbegin(); m != curve.rend() && finest.size() < points; ++m)
    if (m->error > reference_error) finest.push_back(&*m);
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Measured* m : finest) {
    const double x = std::log(m->setting.value), y = std::log(m->error);
    ++n, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// When an embryo has its full charge, the second derivative of the force jumps. The event lies in a
/// step across that instant, so that its time is found with an order between three and four by
/// every method.
constexpr double best_order = 3.5;

void check_orders(Suite& suite, const std::vector<Measured>& measured) {
  std::map<std::string, std::vector<Measured>> curves;
  for (const Measured& m : measured)
    if (!m.setting.adaptive) curves[m.setting.curve()].push_back(m);
  for (const auto& [name, curve] : curves) {
    const Setting& s = curve.front().setting;
    const double order = observed_order(curve);
    if (s.located)
      suite.check_at_least(name + " order", order,
                           std::min<double>(butcher_tableau(s.method).order, best_order)
                               - 0.5);
    else
      suite.check_at_most(name + " order from one", std::abs(order - 1), 0.25);
  }
}

void answer(Suite& suite) {
  Csv csv = suite.csv("integrators.csv",
                      "scene,method,events,landings,control,value,evaluations,steps,"
                      "rejected,seconds_s,position_error_m");
  const std::vector<Setting> all = settings(suite);
  const double refined_cost = 20;
  const std::vector<double> rtols{1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
  std::vector<Setting> refined;
  if (suite.full())
    for (const ButcherTableau& method : butcher_tableaus())
      for (const double rtol : rtols)
        for (const bool landings_located : {false, true})
          if (!method.error.empty())
            refined.push_back(
                {std::string(method.name), true, rtol, true, landings_located});
  suite.plan(static_cast<double>(all.size()) + 1
             + refined_cost
                   * static_cast<double>(refined.empty() ? 0 : refined.size() + 1));

  Study case_one(suite, csv, "case_one", "table2_none", 5e-3, 1);
  check_orders(suite, case_one.run({"dop853", true, 1e-11}, all));
  if (refined.empty()) return;
  Study landings(suite, csv, "table2_04", "table2_04", 0.015, refined_cost);
  landings.run({"dop853", true, 1e-10, true, true}, refined);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "integrators",
                     "Work and precision of the integration methods", answer);
}
