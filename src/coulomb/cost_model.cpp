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
    solver.add_force({{jet.x, jet.y, jet.z}, jet.q}, {jet.fx, jet.fy, jet.fz});
    const double time = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, time), spent += time;
    if (time > 0.3) break;
  }
  return best;
}

constexpr std::array<double, 9> grid_charges{250,  500, 1000, 2000, 4000,
                                             8000, 2e4, 6e4,  2e5};
constexpr std::array<double, 8> grid_tolerances{1e-12, 1e-10, 1e-8, 1e-6,
                                                1e-5,  1e-4,  1e-3, 1e-2};

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

CostModel CostModel::measured(SimdLevel level) {
  CostModel model;
  model.charges.assign(grid_charges.begin(), grid_charges.end());
  model.tolerances.assign(grid_tolerances.begin(), grid_tolerances.end());
  std::vector<TrialJet> jets;
  jets.reserve(grid_charges.size());
  for (const double n : grid_charges) jets.emplace_back(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < priced_solvers.size(); ++k) {
    for (const double tolerance : grid_tolerances) {
      if (priced_solvers[k] == "direct"
          && !model.seconds[k].empty()) { // whatever the tolerance
        model.seconds[k].insert(model.seconds[k].end(), model.seconds[k].begin(),
                                model.seconds[k].begin() + grid_charges.size());
        continue;
      }
      const auto solver = make_coulomb_solver(SolverOptions{
          .solver = std::string(priced_solvers[k]), .tolerance = tolerance, .simd = level});
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
