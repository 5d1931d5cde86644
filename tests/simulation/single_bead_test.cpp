#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// One charged bead that leaves an uncharged nozzle in the field, as nothing else acted on it.
Scene thrown_bead(bool with_gravity, bool with_collector = true) {
  Scene s = chain_scene(FixedEnds::first);
  Bead nozzle = pvp_bead(Vec3::Zero());
  nozzle.charge = 0;
  add_bead(s, nozzle);
  add_bead(s, pvp_bead({0.02 * cm, 0, 0}, {pvp::velocity, 0, 0}));
  s.config.field = FieldConfig{.potential = {}, .strength = pvp::potential / pvp::distance};
  if (with_gravity) s.config.gravity = GravityConfig{pvp::gravity};
  if (with_collector) s.config.collector = CollectorConfig{pvp::distance};
  s.config.coulomb = CoulombConfig{};
  return s;
}

struct Published {
  bool gravity;
  double x, v, landing_time, impact_speed;
};
const Published rows[] = {
    {false, 0.069467789791136, 98.652637461273, 0.018022018028935, 1773.1033650443},
    {true, 0.069958122291136, 99.633302461273, 0.017932865968927, 1781.9196380677},
};

// The path is a parabola, so that every method from second order on is exact.
TEST(SingleBead, falls_along_a_parabola_with_any_method_of_second_order) {
  for (const Published& row : rows) {
    for (const std::string method : {"heun", "rk4", "dormand-prince", "dop853"}) {
      Scene scene = thrown_bead(row.gravity);
      integrate_with_fixed_steps(scene, method, 1e-4 / 3);
      const auto simulation = run(scene, 1e-3);
      const auto c = simulation->jet().columns();
      EXPECT_NEAR(c.position()[1].x() / (row.x * cm), 1, 1e-13) << method;
      EXPECT_NEAR(c.velocity()[1].x() / (row.v * cm), 1, 1e-13) << method;
    }
  }
}

TEST(SingleBead, lands_at_the_root_of_its_parabola_and_stays_there) {
  for (const Published& row : rows) {
    for (const std::string method : {"heun", "rk4", "dormand-prince", "dop853"}) {
      Scene scene = thrown_bead(row.gravity);
      integrate_with_fixed_steps(scene, method, 1e-3 / 3);
      const auto simulation = run(scene, 0.02);
      const JetState& jet = simulation->jet();
      ASSERT_EQ(jet.landed.size(), 1U) << method;
      EXPECT_NEAR(jet.landed[0].time / row.landing_time, 1, 1e-13) << method;
      EXPECT_EQ(jet.columns().position()[1].x(), pvp::distance) << method;
      EXPECT_NEAR(jet.columns().velocity()[1].x() / (row.impact_speed * cm), 1, 1e-13)
          << method;
      EXPECT_EQ(simulation->ledger().impact_speed, jet.columns().velocity()[1].norm());
    }
  }
}

// Explicit Euler lags by exactly a h t/2.
TEST(SingleBead, with_euler_lags_by_half_a_step) {
  const double acceleration =
      pvp::charge_density / pvp::density * pvp::potential / pvp::distance;
  for (const double step : {1e-5, 5e-6}) {
    Scene scene = thrown_bead(false);
    integrate_with_fixed_steps(scene, "euler", step);
    const auto simulation = run(scene, 1e-3);
    const double error = simulation->jet().columns().position()[1].x() - rows[0].x * cm;
    EXPECT_NEAR(error / (-acceleration * step * 1e-3 / 2), 1, 1e-9) << step;
  }
}

} // namespace
} // namespace ehdjet
