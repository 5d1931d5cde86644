#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/budgeted.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// A jet in the air, in which the drag changes its form with no bead while it runs.
Scene jet_in_air(const std::string& method, double rtol_or_step,
                 DragLaw drag = DragLaw::tangential) {
  Scene scene = case_one(method, rtol_or_step);
  scene.config.air = AirConfig{};
  scene.config.air->drag = drag;
  return scene;
}

double order(const std::string& method, double longest, int count) {
  constexpr double end = 5e-4; // five releases
  const JetState exact = run(jet_in_air("dop853", 1e-13), end)->jet();
  std::vector<double> steps, errors;
  for (int i = 0; i < count; ++i) {
    steps.push_back(longest * std::pow(2, -i / 2.0));
    Scene scene = jet_in_air(method, 1e-6);
    integrate_with_fixed_steps(scene, method, steps.back());
    errors.push_back(largest_distance(run(scene, end)->jet(), exact));
  }
  return observed_order(steps, errors);
}

TEST(JetInAir, converges_with_the_order_of_the_method) {
  EXPECT_NEAR(order("rk4", 2e-6, 8), 4, 0.2);
  EXPECT_NEAR(order("ros34pw2", 1e-6, 8), 3, 0.3);
}

// The published law jumps by 2e-5 where its forms meet, which no bead notices at these tolerances.
TEST(JetInAir, converges_with_the_tolerance_whatever_the_method) {
  constexpr double end = 3.5e-3;
  const JetState exact = run(jet_in_air("dop853", 1e-11, DragLaw::anisotropic), end)->jet();
  for (const std::string method : {"dormand-prince", "ros34pw2", "two-rate"}) {
    const auto error = [&](double rtol) {
      return largest_distance(
          run(jet_in_air(method, rtol, DragLaw::anisotropic), end)->jet(), exact);
    };
    const double at_5 = error(1e-5), at_7 = error(1e-7);
    EXPECT_LE(at_5, 2e-5) << method;
    EXPECT_LE(at_7, 0.05 * at_5) << method;
  }
}

TEST(JetInAir, has_a_budget_that_closes) {
  for (const DragLaw law : {DragLaw::anisotropic, DragLaw::tangential}) {
    Scene scene = jet_in_air("dormand-prince", 1e-9, law);
    scene.config.air->velocity = {-1, 0.3, 0};
    scene.config.air->lift = true;
    const FinishedRun budget(scene, 3e-3, 1e-3);
    EXPECT_LE(budget.worst(), 1e-8 * budget.last().at("kinetic_energy"));
    EXPECT_LE(budget.last().at("momentum_residual_relative"), 1e-9);
    EXPECT_LT(budget.last().at("air_work"), -1e-3 * budget.last().at("kinetic_energy"));
    EXPECT_LT(budget.last().at("air_impulse_x"), 0);
  }
}

// A thread of a tenth of a micrometre follows the air within microseconds: explicit steps are then limited
// by that, implicit ones are not.
TEST(JetInAir, lets_thin_threads_follow_a_wind_with_long_implicit_steps) {
  Scene scene = chain_scene();
  const double a = 0.05e-6, l = 1e-3, volume = std::numbers::pi * a * a * l;
  for (int k = 0; k < 20; ++k)
    add_bead(scene, {.position = {k * l, 0, 0},
                     .volume = volume,
                     .mass = pvp::density * volume,
                     .charge = 0});
  scene.config.air = AirConfig{};
  scene.config.air->velocity = {0, 3, 0};
  integrate(scene, "ros34pw2", 1e-6);
  const auto implicit = run(scene, 1e-2);
  integrate(scene, "dormand-prince", 1e-6);
  const auto explicitly = run(scene, 1e-2);
  EXPECT_LE(5 * implicit->statistics().steps, explicitly->statistics().steps);
  EXPECT_LE(largest_distance(implicit->jet(), explicitly->jet()), 1e-7);
  for (std::size_t k = 0; k < 20; ++k)
    EXPECT_NEAR(implicit->jet().columns().velocity().y[k], 3, 1e-5);
}

} // namespace
} // namespace ehdjet
