#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double end = 5e-4; // five releases

JetState jet_after(const Scene& scene) {
  return run(scene, end)->jet();
}

/// Observed order over steps from `longest` downwards by factors of sqrt 2, across insertions.
double order(const std::string& method, double longest, int count,
             EventPlacement placement) {
  const JetState exact = jet_after(case_one("dop853", 1e-13));
  std::vector<double> steps, errors;
  for (int i = 0; i < count; ++i) {
    steps.push_back(longest * std::pow(2, -i / 2.0));
    Scene scene = case_one(method, steps.back());
    scene.config.integrator.events = placement;
    errors.push_back(largest_distance(jet_after(scene), exact));
  }
  return observed_order(steps, errors);
}

// The nozzle turns, beads are inserted and released inside the interval.
TEST(Convergence, across_located_events_has_the_order_of_the_method) {
  EXPECT_NEAR(order("euler", 1e-7, 8, EventPlacement::located), 1, 0.15);
  EXPECT_NEAR(order("heun", 1e-6, 10, EventPlacement::located), 2, 0.15);
  EXPECT_NEAR(order("rk4", 2e-6, 10, EventPlacement::located), 4, 0.15);
}

TEST(Convergence, is_of_first_order_only_if_events_wait_for_the_end_of_a_step) {
  for (const std::string method : {"heun", "rk4"})
    EXPECT_NEAR(order(method, 1e-6, 10, EventPlacement::step_end), 1, 0.3) << method;
}

} // namespace
} // namespace ehdjet
