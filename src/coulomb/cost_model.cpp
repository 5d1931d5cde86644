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
    const std::vector<double> direct{4.143e-05, 0.0002837, 0.002899, 0.02142,
                                     0.3262,    2.936,     32.62};
    for (std::size_t t = 0; t < grid_tolerances.size(); ++t)
      m.seconds[0].insert(m.seconds[0].end(), direct.begin(), direct.end());
    m.seconds[1] = {0.0002656, 0.001166,  0.007958, 0.08557, 0.809,   2.796,  9.163,
                    0.0001585, 0.0007547, 0.005496, 0.06321, 0.555,   1.768,  5.627,
                    0.0001397, 0.0007024, 0.005084, 0.04661, 0.2809,  0.9465, 3.441,
                    0.0001288, 0.0006645, 0.004813, 0.03647, 0.1707,  0.5972, 2.105,
                    0.0001202, 0.0007466, 0.004301, 0.03115, 0.1105,  0.2519, 1.01,
                    0.0001433, 0.0007053, 0.004715, 0.01566, 0.02911, 0.0713, 0.3688};
    m.seconds[2] = {0.0003373, 0.001122,  0.005218, 0.02903,  0.1247,   0.195,   0.4819,
                    0.0002647, 0.0009335, 0.004638, 0.02455,  0.07929,  0.133,   0.308,
                    0.0001445, 0.000538,  0.002998, 0.01764,  0.03934,  0.09389, 0.2065,
                    0.0002105, 0.0005676, 0.002937, 0.01357,  0.0328,   0.06314, 0.173,
                    0.0001648, 0.0006364, 0.003154, 0.009519, 0.01949,  0.03311, 0.08291,
                    0.000131,  0.0005397, 0.001915, 0.00465,  0.007468, 0.01538, 0.06742};
    return m;
  }();
  return model;
}

CostModel CostModel::measured() {
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
