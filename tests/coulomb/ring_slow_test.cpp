#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "coulomb/chains.hpp"

namespace ehdjet::test {
namespace {

struct Ring {
  const char* solver;
  std::size_t n;
  double tolerance;
};

class LargeRings : public testing::TestWithParam<Ring> {};

/// F = q^2/(4 R^2) sum 1/sin(pi k/n), the sum in long double. Rounded coordinates alone change the
/// force, a hundred-thousandth of what neighbours do to each other, by 3e-6 of itself at a
/// million.
TEST_P(LargeRings, are_pushed_outwards_by_the_cosecant_sum) {
  const auto [name, n, tolerance] = GetParam();
  long double sum = 0;
  for (std::size_t k = 1; k < n; ++k)
    sum += 1
           / std::sin(std::numbers::pi_v<long double> * static_cast<long double>(k)
                      / static_cast<long double>(n));
  const Chain ring = helix(n, 1, 2 * std::numbers::pi / static_cast<double>(n), 0);
  const double exact = constants::coulomb / 4 * static_cast<double>(sum);
  const auto solver = make_coulomb_solver({.solver = name, .tolerance = tolerance});
  const Force force = force_on(ring, *solver);
  double square = 0;
  for (std::size_t i = 0; i < n; ++i)
    square += (force[i] - exact * Vec3(ring.r()[i])).squaredNorm();
  const double error = std::sqrt(square / static_cast<double>(n)) / exact;
  EXPECT_LE(error, 1.1 * tolerance);
  EXPECT_GT(error, 1e-3 * tolerance); // or more work than asked for
}

INSTANTIATE_TEST_SUITE_P(
    Solvers, LargeRings,
    testing::Values(Ring{"fmm", 100'000, 1e-3}, Ring{"fmm", 100'000, 1e-5},
                    Ring{"fmm", 1'000'000, 1e-3}, Ring{"fmm", 1'000'000, 1e-5},
                    Ring{"treecode", 100'000, 1e-4}),
    [](const auto& p) { return std::string(p.param.solver) + std::to_string(p.index); });

} // namespace
} // namespace ehdjet::test
