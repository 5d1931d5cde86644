#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

const Vec3 direction{1. / 3, 2. / 3, -2. / 3};
constexpr double r0 = 0.02 * cm;

/// Two charged beads, the second `ratio` times as heavy.
Scene pair_of_charges(double separation, double ratio, double closing_speed = 0) {
  Scene s = chain_scene();
  s.config.coulomb = CoulombConfig{};
  Bead first = pvp_bead(Vec3::Zero(), closing_speed / 2 * direction);
  Bead second = pvp_bead(separation * direction, -closing_speed / 2 * direction);
  second.mass *= ratio;
  add_bead(s, first), add_bead(s, second);
  return s;
}

struct Published {
  double ratio, growth, time;
};

// t(x) = sqrt(mu r0^3 / (2 k q^2)) (sqrt(x(x-1)) + arccosh sqrt x), x = r/r0, mu the reduced mass
TEST(TwoBodies, fly_apart_from_rest_as_the_closed_form_says) {
  const Published rows[] = {
      {1, 2, 5.39315316974245e-5},    {1, 10, 2.656013458751696e-4},
      {1, 100, 2.407901936788273e-3}, {10, 2, 7.272126250567114e-5},
      {10, 10, 3.581367817181825e-4},
  };
  for (const auto& [ratio, growth, time] : rows) {
    for (const bool fixed_steps : {false, true}) {
      Scene scene = pair_of_charges(r0, ratio);
      if (fixed_steps) integrate_with_fixed_steps(scene, "rk4", 1e-6);
      const auto simulation = run(scene, time);
      const auto r = simulation->jet().columns().position();
      // Step 1e-6 s is 1/25 of the time scale: an error of (1/25)^4/120 in the first steps.
      const double tolerance = fixed_steps ? 3e-8 : 1e-11;
      EXPECT_NEAR((r[1] - r[0]).norm() / (growth * r0), 1, tolerance)
          << ratio << " " << growth;
      const Vec3 moved = (growth - 1) * r0 / (1 + ratio) * direction;
      EXPECT_LE((r[0] + ratio * moved).norm(), tolerance * growth * r0) << ratio;
      EXPECT_LE((r[1] - r0 * direction - moved).norm(), tolerance * growth * r0) << ratio;
    }
  }
}

TEST(TwoBodies, of_unequal_mass_keep_their_momentum_to_round_off) {
  const auto simulation = run(pair_of_charges(r0, 10), 3e-4);
  const auto v = simulation->jet().columns().velocity();
  EXPECT_GT(v[0].norm(), 1);
  EXPECT_LE((v[0] + 10 * v[1]).norm(), 1e-14 * v[0].norm()); // round-off of about 40 steps
}

// Energy: m v^2/4 + k q^2/r with v the relative speed; at the turning point v = 0.
TEST(TwoBodies, head_on_turn_where_their_energy_is_all_potential) {
  const double speed = 1000 * cm, start = 20 * cm;
  const double kqq = constants::coulomb * pvp::charge * pvp::charge;
  EXPECT_NEAR(4 * kqq / (pvp::mass * speed * speed), 1.449e-2 * cm,
              5e-6 * cm); // from infinity
  const double energy = pvp::mass * speed * speed / 4 + kqq / start;

  Scene scene = pair_of_charges(start, 1, speed);
  integrate(scene, "dormand-prince", 1e-12);
  scene.config.integrator.position_scale = 0.01 * cm;
  auto simulation = build_simulation(scene);
  double closest = start, residual = 0;
  simulation->after_each_step([&](const Simulation& s) {
    const auto c = s.jet().columns();
    const double r = (c.position()[1] - c.position()[0]).norm();
    const double kinetic =
        pvp::mass / 2 * (c.velocity()[0].squaredNorm() + c.velocity()[1].squaredNorm());
    const double deviation = std::abs(kinetic + kqq / r - energy) / energy;
    residual = deviation <= residual ? residual : deviation;
    closest = std::min(closest, r);
  });
  simulation->run_until(2.2 * start / speed);
  const auto c = simulation->jet().columns();
  EXPECT_GT((c.velocity()[1] - c.velocity()[0]).dot(direction), 0.9 * speed)
      << "did not turn";
  EXPECT_LE(residual, 1e-8);
  // Seen only at the ends of steps: r - r_min is second order in the time from the turn.
  EXPECT_NEAR(closest / (kqq / energy), 1, 1e-3);
}

} // namespace
} // namespace ehdjet
