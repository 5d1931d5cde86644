#include "ehdjet/coulomb/cost_model.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/coulomb/measure_costs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace ehdjet {
namespace {

// The interval of a grid that contains x or is nearest to it, and the position in it in logarithms.
struct Place {
  std::size_t i;
  double part;
};
Place place_of(const std::vector<double>& grid, double x) {
  const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - grid.begin()) - 1;
  return {i, std::log(x / grid[i]) / std::log(grid[i + 1] / grid[i])};
}

struct Trial {
  std::vector<double> x, y, z;
  void add(double a, double b, double c) { x.push_back(a), y.push_back(b), z.push_back(c); }
};

// A jet like that of scenes/pvp.toml: first straight, then a widening helix.
Trial trial_jet(std::size_t n) {
  Trial jet;
  for (std::size_t i = 0; i < n; ++i) {
    // The arc length is roughly proportional to the square of the parameter.
    const double t = std::sqrt(static_cast<double>(i + 1) / static_cast<double>(n));
    const double wide = std::max(0.0, t - 0.1), angle = 40 * std::numbers::pi * wide;
    jet.add(0.16 * t, 0.044 * wide * std::cos(angle), 0.044 * wide * std::sin(angle));
  }
  return jet;
}

// A cube filled by a Kronecker sequence.
Trial trial_cloud(std::size_t n) {
  Trial cloud;
  const auto part = [](double v) { return v - std::floor(v); };
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<double>(i);
    cloud.add(part(0.8191725134 * k), part(0.6710436067 * k), part(0.5497004779 * k));
  }
  return cloud;
}

struct Calls {
  double best = 0, spread = 1; // [s], median over best
};

Calls time_calls(CoulombSolver& solver, const Trial& c) {
  const std::size_t n = c.x.size();
  const std::vector<double> q(n, 1e-10);
  std::vector<double> fx(n), fy(n), fz(n);
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  double spent = 0;
  for (int calls = 0; calls < 3 || (spent < 0.02 && calls < 1000); ++calls) {
    const auto start = Clock::now();
    solver.add_force({{c.x, c.y, c.z}, q}, {fx, fy, fz});
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    times.push_back(time), spent += time;
    if (time > 0.3) break;
  }
  std::ranges::sort(times);
  return {.best = times.front(), .spread = times[times.size() / 2] / times.front()};
}

} // namespace

double CostModel::cost(std::string_view solver, std::size_t n, double tolerance,
                       double crowding) const {
  EHDJET_EXPECTS(std::ranges::find(priced_solvers, solver) != priced_solvers.end());
  const Place c = place_of(charges, static_cast<double>(std::max<std::size_t>(n, 1)));
  const auto along = [&](const std::vector<double>& s, std::size_t row) {
    const double* at = s.data() + row * charges.size() + c.i;
    return std::log(at[0]) + c.part * (std::log(at[1]) - std::log(at[0]));
  };
  if (solver == "direct") return std::exp(along(direct, 0));
  const Place t =
      place_of(tolerances, std::clamp(tolerance, tolerances.front(), tolerances.back()));
  const auto of = [&](const std::vector<double>& s) {
    return along(s, t.i) + t.part * (along(s, t.i + 1) - along(s, t.i));
  };
  return std::exp((1 - crowding) * of(jet) + crowding * of(cloud));
}

std::string_view CostModel::cheapest(std::size_t n, double tolerance,
                                     double crowding) const {
  return *std::ranges::min_element(priced_solvers, {}, [&](std::string_view solver) {
    return cost(solver, n, tolerance, crowding);
  });
}

std::size_t CostModel::crossover(double tolerance, double crowding) const {
  std::size_t low = 1, high = 1'000'000'000;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (cheapest(middle, tolerance, crowding) == "direct" ? low : high) = middle;
  }
  return high;
}

CostModel CostModel::measured(SimdLevel level) {
  return measure_costs(level, {});
}

CostModel measure_costs(SimdLevel level,
                        const std::function<void(const CostTiming&)>& watch) {
  CostModel model;
  CostTiming timing{.number = 0,
                    .all = model.charges.size() * (1 + 2 * model.tolerances.size()),
                    .spread = 1};
  const auto measure = [&](const char* solver, double tolerance, Trial (*make)(std::size_t),
                           std::vector<double>& seconds) {
    const auto timed = make_coulomb_solver(
        SolverOptions{.solver = solver, .tolerance = tolerance, .simd = level});
    for (const double n : model.charges) {
      // The direct sum is quadratic for many charges. Its time is extrapolated.
      const bool known = timed->name() == "direct" && n > 2e4;
      const Trial trial = make(known ? 1 : static_cast<std::size_t>(n));
      const Calls calls =
          known ? Calls{.best = seconds.back()
                                * std::pow(n / model.charges[seconds.size() - 1], 2)}
                : time_calls(*timed, trial);
      seconds.push_back(calls.best);
      ++timing.number, timing.spread = calls.spread;
      if (watch) watch(timing);
    }
  };
  measure("direct", 1e-6, trial_jet, model.direct);
  for (const double tolerance : model.tolerances) {
    measure("fmm", tolerance, trial_jet, model.jet);
    measure("fmm", tolerance, trial_cloud, model.cloud);
  }
  return model;
}

} // namespace ehdjet
