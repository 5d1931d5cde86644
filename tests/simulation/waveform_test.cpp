#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/budgeted.hpp"
#include "support/continued.hpp"
#include "support/refined.hpp"

// External fields that change in time (model 2.6).
namespace ehdjet {
namespace {

using namespace test;

constexpr double strength = pvp::potential / pvp::distance;
constexpr double acceleration = pvp::charge / pvp::mass * strength;
constexpr double start = 1e-3;

FieldConfig square(double frequency) {
  return {.potential = {},
          .strength = strength,
          .waveform = FieldWaveform::square,
          .frequency = frequency};
}
FieldConfig rc(double time_constant) {
  return {.potential = {},
          .strength = strength,
          .waveform = FieldWaveform::rc,
          .time_constant = time_constant};
}

/// One bead that only the field moves.
Scene lone_bead(const FieldConfig& field) {
  Scene s = chain_scene(FixedEnds::first);
  add_bead(s, pvp_bead(Vec3::Zero()));
  add_bead(s, pvp_bead({start, 0, 0}));
  s.config.field = field;
  return s;
}

// In each period it is accelerated for the first half and flies on for the second one.
TEST(SquareWave, moves_a_bead_by_parabolas_and_lines) {
  constexpr double f = 3e3, half = 1 / (2 * f);
  for (const std::string method : {"rk4", "dormand-prince", "ros34pw2"}) {
    Scene scene = lone_bead(square(f));
    if (method == "rk4")
      integrate_with_fixed_steps(scene, method, 0.7e-4);
    else
      integrate(scene, method, 1e-6);
    auto simulation = build_simulation(scene);
    double x = start, v = 0;
    for (int i = 0; i < 20; ++i) {
      const double a = i % 2 == 0 ? acceleration : 0;
      for (const double share : {0.3, 1.0}) {
        const double s = share * half, scale = acceleration * (i + 1) * half;
        simulation->run_until(i * half + s);
        const auto c = simulation->jet().columns();
        EXPECT_NEAR(c.position()[1].x(), x + v * s + a * s * s / 2, 1e-13 * scale) << i;
        EXPECT_NEAR(c.velocity()[1].x(), v + a * s, 1e-12 * scale) << method << ' ' << i;
      }
      x += v * half + a * half * half / 2, v += a * half;
    }
  }
}

TEST(SquareWave, at_the_ends_of_steps_is_late_by_less_than_a_step) {
  Scene scene = lone_bead(square(500)); // on for 1 ms
  integrate_with_fixed_steps(scene, "rk4", 0.7e-3);
  scene.config.integrator.events = EventPlacement::step_end;
  const auto simulation = run(scene, 2e-3);
  EXPECT_NEAR(simulation->jet().columns().velocity()[1].x() / (acceleration * 1.4e-3), 1,
              1e-12);
}

// v = a (t - tau (1 - exp(-t/tau))), x the integral of it.
TEST(RcCircuit, lets_the_field_rise_exponentially) {
  constexpr double tau = 1.3e-3;
  const auto simulation = build_simulation(lone_bead(rc(tau)));
  for (const double t : {0.1e-3, 1e-3, 3e-3, 10e-3}) {
    simulation->run_until(t);
    const double rest = -std::expm1(-t / tau);
    const double v = acceleration * (t - tau * rest),
                 x = start + acceleration * (t * t / 2 - tau * (t - tau * rest));
    const auto c = simulation->jet().columns();
    EXPECT_NEAR(c.velocity()[1].x() / v, 1, 1e-10) << t;
    EXPECT_NEAR(c.position()[1].x() / x, 1, 1e-10) << t;
  }
}

Scene jet(const FieldConfig& field, double rtol) {
  Scene scene = refined_case(0.8 * cm, 1e-3, rtol);
  scene.config.collector->charge = CollectorCharge::grounded;
  scene.config.field = field;
  return scene;
}

TEST(Waveforms, have_a_budget_that_closes) {
  for (const FieldConfig& field : {square(430), rc(2e-3)}) {
    const FinishedRun run(jet(field, 1e-7), 15e-3, 3e-3);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 2e-7);
    EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 2e-7);
    EXPECT_GT(std::abs(run.last().at("field_supply")),
              0.01 * run.last().at("kinetic_energy"));
    EXPECT_GT(run.simulation->statistics().insertions, 50U);
  }
}

// Macro steps end at switches.
TEST(Waveforms, are_the_same_with_two_rates) {
  for (const FieldConfig& field : {square(2.3e3), rc(2e-3)}) {
    Scene scene = jet(field, 1e-6);
    scene.config.integrator.method = "dormand-prince";
    const auto one = run(scene, 15e-3);
    scene.config.integrator.method = "two-rate";
    const auto two = run(scene, 15e-3);
    EXPECT_GT(two->statistics().two_rates->steps, 10U);
    EXPECT_LE(largest_distance(one->jet(), two->jet()), 5e-5);
    EXPECT_EQ(one->jet().field_is_off, two->jet().field_is_off);
  }
}

TEST(Waveforms, go_on_from_a_checkpoint_with_the_same_bits) {
  for (const char* method : {"dormand-prince", "two-rate"}) {
    Scene scene = jet(square(430), 1e-5);
    scene.config.integrator.method = method;
    // Off from 3/860 s to 4/860 s.
    expect_same_bits_after_checkpoints(scene, 3.7e-3, 15e-3);
  }
}

} // namespace
} // namespace ehdjet
