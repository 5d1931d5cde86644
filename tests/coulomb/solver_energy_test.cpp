#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "coulomb/chains.hpp"

namespace ehdjet::test {
namespace {

/// Straight, then a coil that widens.
Chain whipping_jet(std::size_t n) {
  Chain c;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = std::sqrt(static_cast<double>(i + 1) / static_cast<double>(n));
    const double wide = std::max(0.0, t - 0.1), angle = 40 * std::numbers::pi * wide;
    c.add({0.16 * t, 0.044 * wide * std::cos(angle), 0.044 * wide * std::sin(angle)},
          1e-10 * (1 + 0.1 * std::sin(7 * t)));
  }
  return c;
}
Chain gas(std::size_t n) { // in no order
  std::mt19937 bits(3);
  const auto place = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  Chain c;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = place(), y = place(), z = place();
    c.add({x, y, z}, 1);
  }
  return c;
}
Chain unlike_charges(std::size_t n) {
  return random_chain(n, 20, 3);
}

double sum_of_magnitudes(Chain c) {
  for (double& q : c.q) q = std::abs(q);
  return coulomb_energy(c.r(), c.q);
}

TEST(SolverEnergy, is_that_of_all_pairs_within_the_tolerance) {
  const std::pair<const char*, Chain (*)(std::size_t)> geometries[] = {
      {"jet", whipping_jet}, {"gas", gas}, {"unlike", unlike_charges}};
  for (const auto& [name, make] : geometries)
    for (const std::size_t n : {2U, 150U, 1123U, 20'000U}) {
      if (n > 10'000 && make != whipping_jet) continue; // half a minute
      const Chain c = make(n);
      const double exact = coulomb_energy(c.r(), c.q), scale = sum_of_magnitudes(c);
      for (const std::string solver : {"direct", "treecode", "fmm", "auto"})
        for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
          const auto made = make_coulomb_solver({.solver = solver, .tolerance = tolerance});
          const double round_off = 1e-13; // of a sum of 2e8 terms
          EXPECT_LE(std::abs(made->energy(c.r(), c.q) - exact),
                    (solver == "direct" ? round_off : tolerance) * scale)
              << name << ' ' << n << ' ' << solver << ' ' << tolerance;
        }
    }
}

TEST(SolverEnergy, converges_with_the_tolerance) {
  const Chain c = whipping_jet(5000);
  const double exact = coulomb_energy(c.r(), c.q);
  for (const std::string solver : {"treecode", "fmm"}) {
    double before = 1e-3;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const auto made = make_coulomb_solver({.solver = solver, .tolerance = tolerance});
      const double error = std::abs(made->energy(c.r(), c.q) / exact - 1);
      EXPECT_GT(error, 0) << solver << tolerance; // expansions did the work
      EXPECT_LT(error, before / 20) << solver << tolerance;
      before = error;
    }
  }
}

// q^2 n S/(4 R), S = sum 1/sin(pi k/n); the number for n = 10^4 is published.
TEST(SolverEnergy, of_a_ring_is_the_closed_form) {
  constexpr std::size_t n = 10'000;
  const Chain ring = helix(n, 1, 2 * std::numbers::pi / n, 0);
  const double exact = 148586630.407821598 * constants::coulomb;
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    const auto made = make_coulomb_solver({.solver = solver, .tolerance = 1e-8});
    EXPECT_NEAR(made->energy(ring.r(), ring.q) / exact, 1, 1e-8) << solver;
  }
}

TEST(SolverEnergy, is_the_same_in_any_units_with_any_threads_and_after_a_force) {
  const Chain c = whipping_jet(3000);
  for (const std::string solver : {"direct", "treecode", "fmm", "auto"}) {
    const auto made = make_coulomb_solver({.solver = solver, .tolerance = 1e-6});
    const double energy = made->energy(c.r(), c.q);
    const Force before = force_on(c, *make_coulomb_solver({.solver = solver}));
    EXPECT_EQ(force_on(c, *made), before) << solver; // an energy leaves no trace in a force
    EXPECT_EQ(made->energy(c.r(), c.q), energy) << solver;
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    EXPECT_EQ(made->energy(c.r(), c.q), energy) << solver;
    omp_set_num_threads(threads);

    Chain scaled = c;
    for (auto* column : {&scaled.x, &scaled.y, &scaled.z})
      for (double& v : *column) v = std::ldexp(v, 300);
    for (double& q : scaled.q) q = std::ldexp(q, -100);
    EXPECT_EQ(std::ldexp(made->energy(scaled.r(), scaled.q), 500), energy) << solver;
  }
}

TEST(SolverEnergy, skips_coincident_pairs_and_is_zero_without_charges) {
  Chain c = straight_chain(500);
  for (std::size_t i = 100; i < 300; ++i) c.set(i, c.r()[100]);
  const double exact = coulomb_energy(c.r(), c.q);
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    const auto made = make_coulomb_solver({.solver = solver, .tolerance = 1e-9});
    EXPECT_NEAR(made->energy(c.r(), c.q) / exact, 1, 1e-9) << solver;
    EXPECT_EQ(made->energy({}, {}), 0) << solver;
  }
}

} // namespace
} // namespace ehdjet::test
