#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/cost_model.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "coulomb/chains.hpp"
#include "coulomb/clusters.hpp"
#include "coulomb/solvers.hpp"

namespace ehdjet::test {
namespace {

using std::numbers::pi;

/// Straight, then a coil that widens: neighbours cancel each other nearly everywhere.
Chain whipping_jet(std::size_t n) {
  Chain c;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = std::sqrt(static_cast<double>(i + 1) / static_cast<double>(n));
    const double wide = std::max(0.0, t - 0.1), angle = 40 * pi * wide;
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
/// Two coils in one place, their beads taking turns: every neighbour in the list is far.
Chain interleaved_coils(std::size_t n) {
  Chain c;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = 60 * static_cast<double>(i / 2) / static_cast<double>(n);
    const double side = i % 2 == 0 ? 0 : pi;
    c.add({std::cos(s + side), std::sin(s + side), 0.1 * s}, 1);
  }
  return c;
}

double error_of(const Chain& c, const SolverOptions& options) {
  const auto solver = make_coulomb_solver(options);
  Force force = force_on(c, *solver);
  return sampled_error({c.r(), c.q}, force.view(), ToleranceNorm::global, 400).relative_l2;
}

class FastSolvers : public testing::TestWithParam<const char*> {};

TEST_P(FastSolvers, keep_their_tolerance_on_every_geometry) {
  const std::pair<const char*, Chain (*)(std::size_t)> geometries[] = {
      {"jet", whipping_jet},
      {"line", [](std::size_t n) { return straight_chain(n); }},
      {"ring",
       [](std::size_t n) { return helix(n, 1, 2 * pi / static_cast<double>(n), 0); }},
      {"gas", gas},
      {"coils", interleaved_coils}};
  for (const auto& [name, make] : geometries)
    for (const std::size_t n : {150U, 1123U, 6000U}) {
      const Chain c = make(n);
      for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9})
        EXPECT_LE(error_of(c, {.solver = GetParam(), .tolerance = tolerance}),
                  2 * tolerance + 1e-13)
            << name << ' ' << n << ' ' << tolerance;
    }
}

// Net forces shrink against what acts on a bead as beads get denser; the error must follow.
TEST_P(FastSolvers, keep_their_tolerance_where_forces_cancel_a_hundredfold) {
  const Chain c = whipping_jet(60000);
  EXPECT_LE(error_of(c, {.solver = GetParam(), .tolerance = 1e-4}), 1e-4);
}

TEST_P(FastSolvers, converge_with_the_order_at_a_fixed_opening) {
  const Chain c = gas(2000);
  double before = 1;
  for (const int order : {3, 6, 9, 12, 16, 20}) {
    // A tolerance that any opening satisfies: the opening decides.
    const double error = error_of(c, {.solver = GetParam(),
                                      .tolerance = 0.1,
                                      .order = order,
                                      .opening = 0.4,
                                      .leaf = 16});
    EXPECT_LT(error, before / 6)
        << order; // 0.4^3 = 1/16 per three orders, in the worst corner
    before = error;
  }
  EXPECT_LT(before, 1e-9);
}

TEST_P(FastSolvers, handle_one_far_outlier_and_charges_in_one_place) {
  Chain c = whipping_jet(3000);
  c.set(1500, {1e6, -2e6, 5e5});
  EXPECT_LE(error_of(c, {.solver = GetParam(), .tolerance = 1e-6}), 1.2e-6);
  Chain heap(2000);
  for (std::size_t i = 1990; i < 2000; ++i) heap.set(i, static_cast<double>(i) * along);
  const auto solver = make_coulomb_solver({.solver = GetParam(), .tolerance = 1e-6});
  const Force force = force_on(heap, *solver);
  EXPECT_EQ(solver->coincident_pairs(), 1990U * 1989 / 2);
  for (std::size_t i = 0; i < heap.size(); ++i) ASSERT_TRUE(force[i].allFinite());
}

INSTANTIATE_TEST_SUITE_P(Solvers, FastSolvers, testing::Values("treecode", "fmm"),
                         [](const auto& p) { return std::string(p.param); });

// Both members of a pair of clusters feel the same expansions.
TEST(FastMultipole, forces_add_up_to_zero) {
  const Chain c = whipping_jet(5000);
  const auto solver = make_coulomb_solver({.solver = "fmm", .tolerance = 1e-3});
  const Force force = force_on(c, *solver);
  Vec3 sum = Vec3::Zero();
  double magnitudes = 0;
  for (std::size_t i = 0; i < c.size(); ++i) sum += force[i], magnitudes += force[i].norm();
  EXPECT_LE(sum.norm(), 1e-13 * magnitudes);
}

TEST(AutoSolver, takes_the_cheapest_and_stays_with_it_around_the_crossover) {
  const SolverOptions options{.solver = "auto", .tolerance = 1e-6};
  const std::size_t n = CostModel::shipped().crossover(1e-6);
  EXPECT_GT(n, 500U);
  EXPECT_LT(n, 10000U);
  const auto solver = make_coulomb_solver(options);
  const auto uses = [&](std::size_t charges) {
    (void)force_on(straight_chain(charges), *solver);
    const std::string text = solver->description();
    return text.substr(6, text.find_first_of(",", 6) - 6);
  };
  EXPECT_EQ(uses(n / 2), "direct");
  EXPECT_EQ(uses(n - n / 50), "direct");
  EXPECT_EQ(uses(n + n / 50), "direct"); // not worth it
  EXPECT_EQ(uses(2 * n), "fmm");
  EXPECT_EQ(uses(n - n / 50), "fmm"); // neither
  EXPECT_EQ(uses(n / 2), "direct");
  EXPECT_NE(solver->description().find("2 switches"), std::string::npos)
      << solver->description();
}

// Sixteen jets side by side cost several times what one of the same size does.
TEST(AutoSolver, sees_whether_charges_fill_space) {
  detail::Crowding crowding;
  for (const std::size_t n : {4000U, 20'000U}) {
    const Chain jet = whipping_jet(n), cloud = gas(n);
    EXPECT_LE(crowding.of({jet.r(), jet.q}), 0.2) << n;
    EXPECT_GE(crowding.of({cloud.r(), cloud.q}), 0.7) << n;
    Chain jets;
    for (std::size_t k = 0; k < 16; ++k) {
      const Chain one = whipping_jet(n / 16);
      for (std::size_t i = 0; i < one.size(); ++i)
        jets.add(
            one.r()[i]
                + 0.02 * Vec3(0, static_cast<double>(k % 4), static_cast<double>(k / 4)),
            one.q[i]);
    }
    EXPECT_GE(crowding.of({jets.r(), jets.q}), 0.7) << n;
  }
  const CostModel& costs = CostModel::shipped();
  const std::size_t between = (costs.crossover(1e-6) + costs.crossover(1e-6, 1)) / 2;
  EXPECT_GT(costs.crossover(1e-6, 1), 1.5 * static_cast<double>(costs.crossover(1e-6)));
  const auto used = [between](Chain (*make)(std::size_t)) {
    const auto solver = make_coulomb_solver({.solver = "auto", .tolerance = 1e-6});
    (void)force_on(make(between), *solver);
    return solver->description().substr(6, 3);
  };
  EXPECT_EQ(used(whipping_jet), "fmm");
  EXPECT_EQ(used(gas), "dir");
}

TEST(CostModel, interpolates_its_tables_in_logarithms) {
  const CostModel model{.charges = {100, 1000},
                        .tolerances = {1e-6, 1e-2},
                        .direct = {1e-4, 1e-2}, // quadratic, whatever the tolerance
                        .jet = {8e-4, 8e-3, 2e-4, 2e-3}, // linear
                        .cloud = {32e-4, 32e-3, 8e-4, 8e-3}};
  EXPECT_NEAR(model.cost("direct", 100, 1e-6), 1e-4, 1e-18);
  EXPECT_NEAR(model.cost("direct", 10000, 1e-4, 0.5), 1, 1e-12);
  EXPECT_NEAR(model.cost("fmm", 100, 1e-4), 4e-4, 1e-16);
  EXPECT_NEAR(model.cost("fmm", 100, 1e-4, 1), 16e-4, 1e-16);
  EXPECT_NEAR(model.cost("fmm", 100, 1e-4, 0.5), 8e-4, 1e-16);
  EXPECT_NEAR(static_cast<double>(model.crossover(1e-2)), 200, 1); // 1e-8 n^2 = 2e-6 n
  EXPECT_NEAR(static_cast<double>(model.crossover(1e-2, 1)), 800, 1);
  EXPECT_EQ(model.cheapest(100, 1e-6), "direct");
  EXPECT_EQ(model.cheapest(2000, 1e-6), "fmm");
  EXPECT_THROW((void)model.cost("treecode", 100, 1e-6), ContractViolation);
}

/// A direct sum that is wrong by a part in a thousand.
class Wrong final : public CoulombSolver {
public:
  explicit Wrong(int& tightened)
      : tightened_(tightened) {}
  void add_force(const PointCharges& charges, Vec3View force) override {
    exact_->add_force(charges, force);
    for (double& f : force.x) f *= tightened_ < 2 ? 1.001 : 1;
    for (double& f : force.y) f *= tightened_ < 2 ? 1.001 : 1;
    for (double& f : force.z) f *= tightened_ < 2 ? 1.001 : 1;
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    exact_->add_force_from(sources, targets, force);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override { return 0; }
  [[nodiscard]] CoulombAccuracy accuracy() const override { return {.tolerance = 1e-6}; }
  [[nodiscard]] std::string_view name() const override { return "wrong"; }
  void tighten() override { ++tightened_; }

private:
  int& tightened_;
  std::unique_ptr<CoulombSolver> exact_ = make_coulomb_solver({.solver = "direct"});
};

TEST(CheckedSolver, measures_one_of_so_many_calls_and_tightens_a_solver_that_fails) {
  int tightened = 0;
  const auto solver = detail::make_checked_solver(std::make_unique<Wrong>(tightened), 3);
  const Chain c = random_chain(100, 1, 1);
  EXPECT_EQ(solver->checks()->number, 0U); // not yet
  (void)force_on(c, *solver);
  EXPECT_NEAR(solver->checks()->last, 1e-3, 1e-9);
  EXPECT_EQ(solver->checks()->violations, 1U);
  (void)force_on(c, *solver), (void)force_on(c, *solver);
  EXPECT_EQ(solver->checks()->violations, 1U); // not looked at
  (void)force_on(c, *solver);
  EXPECT_EQ(tightened, 2);
  for (int i = 0; i < 3; ++i) (void)force_on(c, *solver);
  EXPECT_LE(solver->checks()->last, 1e-14);
  EXPECT_EQ(solver->checks()->violations, 2U);
  EXPECT_NE(solver->description().find("3 checks"), std::string::npos);
}

TEST(CheckedSolver, adds_the_same_force_as_an_unchecked_one) {
  const Chain c = whipping_jet(2000);
  const SolverOptions plain{.solver = "fmm", .tolerance = 1e-6};
  SolverOptions checked = plain;
  checked.check_every = 1;
  EXPECT_EQ(force_on(c, *make_coulomb_solver(plain)),
            force_on(c, *make_coulomb_solver(checked)));
}

TEST(MakeSolver, refuses_what_no_solver_can_do) {
  const auto refused = [](const SolverOptions& o) {
    EXPECT_THROW(make_coulomb_solver(o), InputError);
  };
  refused({.solver = "magic"});
  refused({.solver = "fmm", .tolerance = 1e-15});
  refused({.solver = "fmm", .tolerance = 0.5});
  refused({.solver = "fmm", .tolerance = std::nan("")});
  refused({.solver = "fmm", .order = 1});
  refused({.solver = "treecode", .order = 40});
  refused({.solver = "fmm", .opening = 1.0});
  refused({.solver = "fmm", .leaf = 20});
  refused({.solver = "auto", .tolerance = 0});
}

} // namespace
} // namespace ehdjet::test
