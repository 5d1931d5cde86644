#include <gtest/gtest.h>

#include <string>

#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

Scene solved_by(Scene scene, const std::string& solver, double tolerance) {
  scene.config.coulomb->solver = solver;
  scene.config.coulomb->tolerance = tolerance;
  return scene;
}

// What a solver's tolerance does to the jet, against what the integrator's does.
TEST(FastSolverRuns, differ_from_the_direct_sum_by_less_than_the_integrator_errs) {
  for (const bool refined : {false, true}) {
    const auto scene = [refined](double rtol) {
      return refined ? refined_case(0.4 * cm, 1e-3, rtol)
                     : case_one("dormand-prince", rtol);
    };
    const double end = 8.5e-3;
    const auto exact = run(scene(1e-8), end), direct = run(scene(1e-5), end);
    const double integration = largest_distance(direct->jet(), exact->jet());
    EXPECT_GT(integration, 1e-7);
    for (const std::string solver : {"fmm", "treecode", "auto"}) {
      const auto fast = run(solved_by(scene(1e-5), solver, 1e-6), end);
      EXPECT_LT(largest_distance(fast->jet(), direct->jet()), integration)
          << solver << refined;
    }
  }
}

// A few beads at a nozzle have nearly all of |F|^2.
TEST(FastSolverRuns, have_the_norm_of_the_beads_that_move_if_there_is_a_nozzle) {
  Scene scene = refined_case(0.4 * cm, 1e-3);
  scene.config.coulomb = CoulombConfig{.solver = "fmm"};
  EXPECT_EQ(solver_options(scene.config, {}).norm, ToleranceNorm::moving);
  scene.config.coulomb->norm = ToleranceNorm::per_bead;
  EXPECT_EQ(solver_options(scene.config, {}).norm, ToleranceNorm::per_bead);
  Scene chain = chain_scene();
  chain.config.coulomb = CoulombConfig{.solver = "fmm"};
  EXPECT_EQ(solver_options(chain.config, {}).norm, ToleranceNorm::global);
}

TEST(FastSolverRuns, report_the_error_of_their_checks) {
  Scene scene = solved_by(case_one("dormand-prince", 1e-4), "fmm", 1e-4);
  const auto unchecked = run(scene, 2e-3);
  EXPECT_EQ(unchecked->statistics().coulomb_error, std::nullopt);
  scene.config.coulomb->check_every = 50;
  const auto checked = run(scene, 2e-3);
  ASSERT_TRUE(checked->statistics().coulomb_error);
  EXPECT_LE(*checked->statistics().coulomb_error, 1e-4);
  EXPECT_EQ(checked->jet().y, unchecked->jet().y);
}

} // namespace
} // namespace ehdjet
