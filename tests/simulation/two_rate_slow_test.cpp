#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/refined.hpp"
#include "support/two_rates.hpp"

// Two rates against one at a tight tolerance, where that takes seconds.
namespace ehdjet {
namespace {

using namespace test;

Scene two_rates(double length, double rtol) {
  Scene scene = refined_case(length);
  integrate(scene, "two-rate", rtol);
  return scene;
}

double distance_from_one_rate(const JetState& jet, double length, double rtol) {
  const auto exact = run(refined_case(length, 1e-3, rtol), jet.time);
  return largest_distance(jet, exact->jet());
}

TEST(TwoRate, error_and_cost_at_eight_millimetres_for_two_tolerances) {
  auto loose = build_simulation(two_rates(0.8 * cm, 1e-5)),
       tight = build_simulation(two_rates(0.8 * cm, 1e-6));
  const Cost cost = cost_between(*loose, 15e-3, 20e-3),
             more = cost_between(*tight, 15e-3, 20e-3);
  EXPECT_LE(cost.evaluations, 60);
  EXPECT_LE(cost.full_sums, 95);
  EXPECT_LE(more.evaluations, 250);
  EXPECT_LE(distance_from_one_rate(loose->jet(), 0.8 * cm, 1e-9), 2e-3 * cm);
  EXPECT_LE(distance_from_one_rate(tight->jet(), 0.8 * cm, 1e-9), 1.1e-4 * cm);
  EXPECT_EQ(loose->statistics().landings, tight->statistics().landings);
}

TEST(TwoRate, error_and_cost_at_two_millimetres) {
  auto simulation = build_simulation(two_rates(0.2 * cm, 1e-5));
  const Cost cost = cost_between(*simulation, 12e-3, 15e-3);
  EXPECT_LE(cost.evaluations, 50);
  EXPECT_LE(cost.full_sums, 55);
  EXPECT_LE(distance_from_one_rate(simulation->jet(), 0.2 * cm, 1e-8), 1.2e-3 * cm);
}

// So fine a mesh has coils that touch the plate in the middle first. A step that such a landing ends
// would be thrown away, and every landing would cost seven evaluations: 1,100 of them per millisecond.
TEST(TwoRate, beads_that_land_out_of_order_do_not_end_steps) {
  const auto simulation = run(two_rates(0.05 * cm, 1e-5), 12e-3);
  const RunStatistics& s = simulation->statistics();
  EXPECT_GT(s.landings, 500U);
  EXPECT_LE(s.rejected, s.steps / 20);
  EXPECT_LE(s.two_rates->steps, 200U);
  EXPECT_LE(
      distance_from_one_rate(run(two_rates(0.05 * cm, 1e-5), 9e-3)->jet(), 0.05 * cm, 1e-6),
      1e-3 * cm);
}

} // namespace
} // namespace ehdjet
