#include "ehdjet/events/landing.hpp"
#include "ehdjet/integrators/butcher_tableau.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double h = pvp::distance;

struct Start {
  double x, vx, vy;
};

/// Beads that fly freely towards the collector, each known in closed form.
Scene flight(const std::vector<Start>& beads, const std::string& method = "rk4") {
  Scene s = chain_scene(FixedEnds::first);
  s.config.collector = CollectorConfig{h};
  double side = 0;
  for (const Start& b : beads) {
    Bead bead = pvp_bead({b.x, side, -side / 2}, {b.vx, b.vy, 0});
    bead.mass *= 1 + 100 * side, bead.charge *= 1 + 200 * side,
        bead.volume *= 1 + 300 * side;
    add_bead(s, bead);
    side += 1e-3;
  }
  integrate_with_fixed_steps(s, method, 1e-3);
  return s;
}

double radius_of(const JetState& jet, std::size_t bead, double length) {
  return std::sqrt(jet.volume[bead] / (std::numbers::pi * length));
}

// Bead 3 overtakes the leading bead 4.
const std::vector<Start> overtaking{
    {0, 0, 0}, {0.10, 3, 1}, {0.12, 4, 2}, {h - 0.002, 5, 3}, {h - 0.01, 6, -4}};

TEST(Landing, an_interior_bead_freezes_and_waits) {
  for (const std::string method : {"euler", "rk4", "dormand-prince", "dop853"}) {
    auto simulation = build_simulation(flight(overtaking, method));
    std::vector<DepositedBead> deposit;
    simulation->add(std::make_unique<Deposit>(deposit));
    simulation->run_until(1e-3); // bead 3 lands at 0.4 ms, bead 4 would at 1.667 ms
    const JetState& jet = simulation->jet();
    ASSERT_EQ(jet.landed.size(), 1U) << method;
    EXPECT_EQ(jet.landed[0].bead, 3U);
    EXPECT_NEAR(jet.landed[0].time, 0.4e-3, 1e-15) << method;
    EXPECT_EQ(jet.beads(), 5U);
    EXPECT_TRUE(deposit.empty());
    // It keeps its velocity as a record and its place at the collector.
    EXPECT_EQ(jet.columns().velocity()[3], Vec3(5, 3, 0));
    EXPECT_LE((jet.columns().position()[3] - Vec3(h, 3e-3 + 1.2e-3, -1.5e-3)).norm(),
              1e-15);
    EXPECT_EQ(jet.columns().position()[3].x(), h);
    EXPECT_NEAR(jet.columns().position()[4].x(), h - 0.004, 1e-15);
    EXPECT_NEAR(
        jet.landed[0].radius
            / radius_of(jet, 3,
                        (Vec3(h, 4.2e-3, -1.5e-3) - Vec3(0.1216, 2.8e-3, -1e-3)).norm()),
        1, 1e-13);
    EXPECT_EQ(simulation->statistics().landings, 1U);
    EXPECT_NEAR(simulation->ledger().impact_speed, std::sqrt(34.), 1e-14);
  }
}

TEST(Landing, the_leading_bead_leaves_at_once_if_its_neighbour_has_landed_before_it) {
  auto simulation = build_simulation(flight(overtaking));
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(2e-3);
  const JetState& jet = simulation->jet();
  ASSERT_EQ(deposit.size(), 1U);
  const DepositedBead& left = deposit[0];
  EXPECT_NEAR(left.time, 0.01 / 6, 1e-15);
  EXPECT_EQ(left.removal_time, left.time);
  EXPECT_LE((left.bead.position - Vec3(h, 4e-3 - 4 * 0.01 / 6, -2e-3)).norm(), 1e-15);
  EXPECT_EQ(left.bead.velocity, Vec3(6, -4, 0));
  EXPECT_EQ(left.radius, left.landing_radius);
  EXPECT_NEAR(left.bead.mass / (pvp::mass * 1.4), 1, 1e-15);
  EXPECT_NEAR(left.bead.charge / (pvp::charge * 1.8), 1, 1e-15);
  EXPECT_NEAR(left.bead.volume / (pvp::volume * 2.2), 1, 1e-15);
  ASSERT_EQ(jet.beads(), 4U);
  ASSERT_EQ(jet.landed.size(), 1U);
  EXPECT_EQ(jet.landed[0].bead, 3U);
}

// The leading bead stays and pulls until its upstream neighbour has landed too.
TEST(Landing, at_most_one_landed_bead_stays_at_the_end_of_the_chain) {
  const std::vector<Start> in_order{
      {0, 0, 0}, {0.10, 20, 1}, {0.12, 15, 2}, {h - 0.02, 12, 3}, {h - 0.01, 10, -4}};
  const double landing[] = {0, 0.06 / 20, 0.04 / 15, 0.02 / 12, 0.001};
  auto simulation = build_simulation(flight(in_order));
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(1.5e-3);
  EXPECT_EQ(simulation->jet().beads(), 5U);
  EXPECT_TRUE(simulation->jet().is_landed(4));
  simulation->run_until(4e-3);
  ASSERT_EQ(deposit.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = 4 - i;
    EXPECT_NEAR(deposit[i].time, landing[k], 1e-15) << k;
    EXPECT_NEAR(deposit[i].removal_time, landing[k - 1], 1e-15) << k;
    EXPECT_NE(deposit[i].radius, deposit[i].landing_radius) << k;
  }
  // Its link at its removal: from where both lie on the collector.
  const Vec3 r4(h, 4e-3 - 4e-3, -2e-3), r3(h, 3e-3 + 3 * landing[3], -1.5e-3);
  const double radius =
      std::sqrt(deposit[0].bead.volume / (std::numbers::pi * (r4 - r3).norm()));
  EXPECT_NEAR(deposit[0].radius / radius, 1, 1e-12);
  const JetState& jet = simulation->jet();
  ASSERT_EQ(jet.beads(), 2U); // the nozzle and the last bead, landed
  EXPECT_TRUE(jet.is_landed(1));
  EXPECT_EQ(simulation->ledger().removed_beads, 3U);
}

TEST(Landing, beads_that_arrive_at_the_same_instant_all_land) {
  const std::vector<Start> together{
      {0, 0, 0}, {0.10, 1, 0}, {h - 0.005, 10, 1}, {h - 0.01, 20, 2}, {h - 0.0025, 5, 3}};
  for (const std::string method : {"rk4", "dop853"}) {
    auto simulation = build_simulation(flight(together, method));
    std::vector<DepositedBead> deposit;
    simulation->add(std::make_unique<Deposit>(deposit));
    simulation->run_until(1e-3);
    EXPECT_EQ(simulation->statistics().landings, 3U) << method;
    ASSERT_EQ(deposit.size(), 2U) << method;
    EXPECT_EQ(deposit[0].bead.velocity.x(), 5) << method;
    EXPECT_EQ(deposit[1].bead.velocity.x(), 20) << method;
    EXPECT_EQ(simulation->jet().beads(), 3U) << method;
  }
}

TEST(Landing, at_step_ends_freezes_all_that_have_passed_the_collector) {
  Scene scene = flight(overtaking);
  scene.config.integrator.events = EventPlacement::step_end;
  auto simulation = build_simulation(scene);
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(2e-3);
  ASSERT_EQ(deposit.size(), 1U);
  EXPECT_NEAR(deposit[0].time, 2e-3, 1e-15);
  EXPECT_EQ(deposit[0].bead.position.x(), h);
  EXPECT_EQ(simulation->jet().columns().position()[3].x(), h);
}

// Bead 0 of a chain is a bead like any other unless it is held; the nozzle never lands.
TEST(Landing, a_free_bead_0_lands_and_a_held_one_does_not) {
  const std::vector<Start> both_arrive{{h - 0.002, 2, 1}, {h - 0.003, 6, 2}};
  Scene scene = flight(both_arrive);
  scene.config.chain->fixed = FixedEnds::none;
  auto simulation = build_simulation(scene);
  simulation->run_until(3e-3);
  const JetState& jet = simulation->jet();
  ASSERT_EQ(jet.landed.size(), 2U);
  EXPECT_EQ(jet.landed[0].bead, 0U);
  EXPECT_NEAR(jet.landed[0].time, 1e-3, 1e-15);
  EXPECT_EQ(jet.columns().position()[0].x(), h);
  EXPECT_EQ(jet.beads(), 2U); // a link needs its two ends

  auto held = build_simulation(flight(both_arrive));
  held->run_until(3e-3);
  ASSERT_EQ(held->jet().landed.size(), 1U);
  EXPECT_EQ(held->jet().landed[0].bead, 1U);
}

// A Maxwell link below an interior landed bead stretches by the lower bead's velocity alone.
TEST(Landing, the_link_below_a_landed_interior_bead_sees_it_at_rest) {
  Scene scene = flight(overtaking);
  scene.config.viscoelasticity = ViscoelasticityConfig{
      .elastic_modulus = 1e-6, .viscosity = 1e30}; // pulls nothing aside
  integrate(scene, "dop853", 1e-12);
  scene.config.integrator.stress_scale = 1e-6;
  auto simulation = build_simulation(scene);
  simulation->run_until(0.4e-3);
  simulation->run_until(1.2e-3);
  const JetState& jet = simulation->jet();
  // Both ends in free flight until 0.4 ms, then the upper one at rest: sigma = G ln(l/l0).
  const auto length = [&](const Vec3& upper, const Vec3& lower) {
    return (lower - upper).norm();
  };
  const double l0 = length({h - 0.002, 3e-3, -1.5e-3}, {h - 0.01, 4e-3, -2e-3});
  const double l1 = length(jet.columns().position()[3], jet.columns().position()[4]);
  EXPECT_NEAR(stress_of(jet.columns())[4] / (1e-6 * std::log(l1 / l0)), 1, 1e-7);
  // Its own link keeps the stress of the landing.
  const double own0 = length({0.12, 2e-3, -1e-3}, {h - 0.002, 3e-3, -1.5e-3});
  const double own1 = length({0.1216, 2.8e-3, -1e-3}, {h, 4.2e-3, -1.5e-3});
  EXPECT_NEAR(stress_of(jet.columns())[3] / (1e-6 * std::log(own1 / own0)), 1, 1e-7);
}

} // namespace
} // namespace ehdjet
