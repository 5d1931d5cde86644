#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

struct Fluid {
  const char* name;
  double modulus, viscosity; // [Pa], [Pa s]
};

/// A hard elastic fluid and one that relaxes at once: explicit steps are limited to 5e-7 s by elastic
/// waves in the one, to 5.6e-7 s by relaxation in the other.
class StiffJets : public testing::TestWithParam<Fluid> {
protected:
  static Scene scene(const std::string& method, double length, double rtol) {
    Scene s = refined_case(length, 1e-3, rtol);
    s.config.integrator.method = method;
    s.config.viscoelasticity =
        ViscoelasticityConfig{GetParam().modulus, GetParam().viscosity};
    return s;
  }
};

// To 20 ms, with insertion, landing and refinement.
TEST_P(StiffJets, take_at_most_five_times_the_evaluations_of_the_pvp_jet) {
  const double end = 20e-3;
  const auto pvp = run(refined_case(0.2 * cm, 1e-3, 1e-5), end);
  const RunStatistics cost = run(scene("ros34pw2", 0.2 * cm, 1e-5), end)->statistics();
  EXPECT_LE(cost.evaluations, 5 * pvp->statistics().evaluations);
  EXPECT_GT(cost.landings, 500U);
  // With two rates, both of which choose the implicit method.
  const RunStatistics two = run(scene("auto", 0.2 * cm, 1e-5), end)->statistics();
  EXPECT_LE(two.evaluations,
            cost.evaluations / 2); // most of them before there are 200 beads
  EXPECT_EQ(two.landings, cost.landings);
  EXPECT_EQ(two.method->in_use, "two-rate");
  EXPECT_LE(two.method->changes, 3U);
}

// The motion is not chaotic.
TEST_P(StiffJets, converge_in_rtol) {
  const auto path = [](const std::string& method, double rtol) {
    return path_length_of(run(scene(method, 0.8 * cm, rtol), 15e-3)->jet());
  };
  const double exact = path("ros34pw2", 1e-7),
               error = std::abs(path("ros34pw2", 1e-4) - exact),
               less = std::abs(path("ros34pw2", 1e-5) - exact),
               least = std::abs(path("ros34pw2", 1e-6) - exact);
  EXPECT_LE(error, 2e-3 * exact);
  EXPECT_LE(less, 0.4 * error);
  EXPECT_LE(least, 0.4 * less);
  // With two rates it is the same jet.
  const double two = std::abs(path("auto", 1e-5) - exact),
               tight = std::abs(path("auto", 1e-6) - exact);
  EXPECT_LE(two, less);
  EXPECT_LE(tight, less);
}

INSTANTIATE_TEST_SUITE_P(Fluids, StiffJets,
                         testing::Values(Fluid{"hard", 1e8, 2}, Fluid{"thin", 5e3, 1e-3}),
                         [](const auto& p) { return std::string(p.param.name); });

} // namespace
} // namespace ehdjet
