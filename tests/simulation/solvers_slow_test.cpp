#include <gtest/gtest.h>

#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

// Case I and the refined rows of Table 2, every bead after 20 ms.
TEST(FastSolverRunsSlow, differ_from_the_direct_sum_by_less_than_the_integrator_errs) {
  for (const double length : {0.0, 0.8, 0.4, 0.2}) {
    const auto scene = [length](double rtol) {
      return length == 0 ? case_one("dormand-prince", rtol)
                         : refined_case(length * cm, 1e-3, rtol);
    };
    Scene fast = scene(1e-5);
    fast.config.coulomb->solver = "fmm";
    fast.config.coulomb->tolerance = 1e-6;
    const double end = 20e-3;
    const auto exact = run(scene(1e-7), end), direct = run(scene(1e-5), end);
    const double integration = largest_distance(direct->jet(), exact->jet());
    const double solver = largest_distance(run(fast, end)->jet(), direct->jet());
    EXPECT_GT(integration, 1e-8) << length;
    EXPECT_LT(solver, integration) << length;
  }
}

} // namespace
} // namespace ehdjet
