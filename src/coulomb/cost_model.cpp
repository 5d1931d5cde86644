#include "ehdjet/coulomb/cost_model.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

namespace ehdjet {
namespace {

std::size_t index_of(std::string_view solver) {
  const auto found = std::ranges::find(priced_solvers, solver);
  EHDJET_EXPECTS(found != priced_solvers.end());
  return static_cast<std::size_t>(found - priced_solvers.begin());
}

// Interval of a grid that x is in or next to, and where in it, in logarithms.
struct Place {
  std::size_t i;
  double part;
};
Place place_of(const std::vector<double>& grid, double x) {
  const auto above = std::upper_bound(grid.begin() + 1, grid.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - grid.begin()) - 1;
  return {i, std::log(x / grid[i]) / std::log(grid[i + 1] / grid[i])};
}

// A jet like that of scenes/pvp.toml: straight, then a helix that widens.
struct TrialJet {
  std::vector<double> x, y, z, q, fx, fy, fz;
  explicit TrialJet(std::size_t n)
      : q(n, 1e-10)
      , fx(n)
      , fy(n)
      , fz(n) {
    for (std::size_t i = 0; i < n; ++i) {
      // Arc length grows about with the square of the parameter.
      const double t = std::sqrt(static_cast<double>(i + 1) / static_cast<double>(n));
      const double wide = std::max(0.0, t - 0.1), angle = 40 * std::numbers::pi * wide;
      x.push_back(0.16 * t);
      y.push_back(0.044 * wide * std::cos(angle)),
          z.push_back(0.044 * wide * std::sin(angle));
    }
  }
};

double seconds_per_call(CoulombSolver& solver, TrialJet& jet) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300, spent = 0;
  for (int calls = 0; calls < 3 || (spent < 0.02 && calls < 1000); ++calls) {
    const auto start = Clock::now();
    solver.add_force({jet.x, jet.y, jet.z}, jet.q, {jet.fx, jet.fy, jet.fz});
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, time), spent += time;
    if (time > 0.3) break;
  }
  return best;
}

constexpr std::array<double, 7> grid_charges{250, 700, 2000, 6000, 2e4, 6e4, 2e5};
constexpr std::array<double, 6> grid_tolerances{1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2};

} // namespace

double CostModel::cost(std::string_view solver, std::size_t n, double tolerance) const {
  const auto& s = seconds[index_of(solver)];
  const Place c = place_of(charges, static_cast<double>(std::max<std::size_t>(n, 1)));
  const Place t =
      place_of(tolerances, std::clamp(tolerance, tolerances.front(), tolerances.back()));
  const auto at = [&](std::size_t i, std::size_t j) {
    return std::log(s[i * charges.size() + j]);
  };
  const auto along = [&](std::size_t i) {
    return at(i, c.i) + c.part * (at(i, c.i + 1) - at(i, c.i));
  };
  return std::exp(along(t.i) + t.part * (along(t.i + 1) - along(t.i)));
}

std::string_view CostModel::cheapest(std::size_t n, double tolerance) const {
  return *std::ranges::min_element(priced_solvers, {}, [&](std::string_view solver) {
    return cost(solver, n, tolerance);
  });
}

std::size_t CostModel::crossover(double tolerance) const {
  std::size_t low = 1, high = 1'000'000'000;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (cheapest(middle, tolerance) == "direct" ? low : high) = middle;
  }
  return high;
}

const CostModel& CostModel::shipped() {
  // `ehdjet calibrate` on one core of an AMD EPYC (Zen 3), AVX2.
  static const CostModel model = [] {
    CostModel m;
    m.charges.assign(grid_charges.begin(), grid_charges.end());
    m.tolerances.assign(grid_tolerances.begin(), grid_tolerances.end());
    const std::vector<double> direct{5.47e-05, 0.0002851, 0.002661, 0.02047,
                                     0.2553,   2.297,     25.53};
    for (std::size_t t = 0; t < grid_tolerances.size(); ++t)
      m.seconds[0].insert(m.seconds[0].end(), direct.begin(), direct.end());
    m.seconds[1] = {0.0002162, 0.0009808, 0.00871,  0.08314,  0.6914,  2.272,   7.961,
                    0.0002042, 0.0007664, 0.007642, 0.06604,  0.5134,  1.717,   5.104,
                    0.0001871, 0.0009312, 0.006235, 0.04377,  0.256,   0.9821,  3.159,
                    0.0001252, 0.0006525, 0.004484, 0.03549,  0.1631,  0.4331,  1.47,
                    0.0001192, 0.0006075, 0.004038, 0.01964,  0.06648, 0.2042,  0.7094,
                    0.0001136, 0.0005177, 0.003312, 0.009185, 0.02162, 0.05629, 0.2018};
    m.seconds[2] = {0.000221,  0.0007623, 0.003639, 0.02001,  0.1004,   0.2034,  0.3206,
                    0.0001748, 0.0006295, 0.003471, 0.01638,  0.05125,  0.108,   0.2054,
                    0.0001396, 0.0005378, 0.002874, 0.01471,  0.03415,  0.0538,  0.1342,
                    0.0001152, 0.0004656, 0.002584, 0.01046,  0.02036,  0.03437, 0.1007,
                    0.0001201, 0.0004704, 0.001944, 0.004724, 0.008934, 0.02304, 0.06389,
                    9.741e-05, 0.0004925, 0.001677, 0.003165, 0.005887, 0.01459, 0.04793};
    return m;
  }();
  return model;
}

CostModel CostModel::measured() {
  CostModel model;
  model.charges.assign(grid_charges.begin(), grid_charges.end());
  model.tolerances.assign(grid_tolerances.begin(), grid_tolerances.end());
  std::vector<TrialJet> jets;
  for (const double n : grid_charges) jets.emplace_back(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < priced_solvers.size(); ++k) {
    for (const double tolerance : grid_tolerances) {
      if (priced_solvers[k] == "direct"
          && !model.seconds[k].empty()) { // whatever the tolerance
        model.seconds[k].insert(model.seconds[k].end(), model.seconds[k].begin(),
                                model.seconds[k].begin() + grid_charges.size());
        continue;
      }
      const auto solver = make_coulomb_solver(
          SolverOptions{.solver = std::string(priced_solvers[k]), .tolerance = tolerance});
      for (TrialJet& jet : jets) {
        const double n = static_cast<double>(jet.q.size());
        // Nobody sums 2e5 charges pair by pair: continued from where the sum is quadratic.
        const bool long_known = priced_solvers[k] == "direct" && n > 2e4;
        const auto& known = model.seconds[k];
        model.seconds[k].push_back(
            long_known ? known.back() * std::pow(n / grid_charges[known.size() - 1], 2)
                       : seconds_per_call(*solver, jet));
      }
    }
  }
  return model;
}

} // namespace ehdjet
