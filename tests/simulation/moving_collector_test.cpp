#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "support/budgeted.hpp"
#include "support/refined.hpp"

// A collector that moves in its plane and takes landed beads along (model 5.1).
namespace ehdjet {
namespace {

using namespace test;

constexpr double h = pvp::distance;
const Vec3 velocity{0, 2, -0.5};

void move_collector(Scene& scene, const Vec3& u) {
  scene.config.collector->velocity = {u.x(), u.y(), u.z()};
}

std::vector<DepositedBead> deposit_of(const Scene& scene, double end_time) {
  std::vector<DepositedBead> deposit;
  auto simulation = build_simulation(scene);
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(end_time);
  return deposit;
}

/// A free chain of beads, all of which land within 15 ms; as seen by somebody who moves at -u.
Scene falling_chain(const Vec3& u) {
  Scene s = chain_scene();
  s.config.collector = CollectorConfig{.distance = h};
  s.config.field = FieldConfig{.potential = {}, .strength = pvp::potential / h};
  s.config.coulomb = CoulombConfig{};
  s.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  s.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension,
                                                  .form = SurfaceTensionForm::line};
  for (int k = 0; k < 30; ++k)
    add_bead(s, pvp_bead({0.02 + 2e-3 * k, 1e-3 * std::cos(k), 1e-3 * std::sin(k)},
                         Vec3(5, 0.1 * std::sin(2 * k), 0) + u));
  if (u != Vec3::Zero()) move_collector(s, u);
  return s;
}

// Places are those of the coordinates that are fixed to the plate.
TEST(MovingCollector, looks_like_one_at_rest_to_those_who_move_with_it) {
  for (const std::string method : {"dormand-prince", "ros34pw2"})
    for (const LandingSteps landings : {LandingSteps::automatic, LandingSteps::located}) {
      Scene at_rest = falling_chain(Vec3::Zero()), moving = falling_chain(velocity);
      for (Scene* s : {&at_rest, &moving}) {
        integrate(*s, method, 1e-8);
        s->config.integrator.landings = landings;
      }
      const auto a = deposit_of(at_rest, 15e-3), b = deposit_of(moving, 15e-3);
      ASSERT_GE(a.size(), 25U) << method;
      ASSERT_EQ(a.size(), b.size()) << method;
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i].time, b[i].time, 1e-8) << method << ' ' << i;
        EXPECT_NEAR(a[i].removal_time, b[i].removal_time, 1e-8);
        EXPECT_LE((a[i].bead.position - b[i].bead.position).norm(), 1e-7)
            << method << ' ' << i;
        EXPECT_LE((a[i].bead.velocity + velocity - b[i].bead.velocity).norm(), 1e-4);
        EXPECT_NEAR(a[i].radius / b[i].radius, 1, 1e-4);
      }
    }
}

TEST(MovingCollector, takes_the_landed_bead_along) {
  Scene s = chain_scene(FixedEnds::first);
  s.config.collector = CollectorConfig{.distance = h};
  move_collector(s, velocity);
  add_bead(s, pvp_bead(Vec3::Zero()));
  add_bead(s, pvp_bead({h - 0.03, 0, 0}, {10, 1, 0}));
  add_bead(s, pvp_bead({h - 0.01, 2e-3, 0}, {10, 1, 0})); // lands at 1 ms
  auto simulation = build_simulation(s);
  simulation->run_until(2e-3);
  const JetState& jet = simulation->jet();
  ASSERT_EQ(jet.landed.size(), 1U);
  EXPECT_LE((jet.columns().position()[2] - Vec3(h, 3e-3 + 2e-3, -0.5e-3)).norm(), 1e-15);
  EXPECT_EQ(jet.columns().velocity()[2], Vec3(10, 1, 0)); // of its impact
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(4e-3); // bead 1 lands at 3 ms
  ASSERT_EQ(deposit.size(), 1U);
  EXPECT_LE((deposit[0].bead.position - Vec3(h, 1e-3, 0.5e-3)).norm(), 1e-15);
}

// pitch = U/rate
TEST(MovingCollector, spreads_a_straight_jet_by_velocity_over_rate) {
  Scene scene = straight_jet(0.3);
  move_collector(scene, {0, 0, 0.3});
  const auto deposit = deposit_of(scene, 0.4);
  ASSERT_GE(deposit.size(), 60U);
  const std::size_t last = deposit.size() - 1, first = last - 40;
  const double rate = 40 / (deposit[last].time - deposit[first].time);
  const double pitch =
      (deposit[first].bead.position.z() - deposit[last].bead.position.z()) / 40;
  EXPECT_NEAR(pitch / (0.3 / rate), 1, 1e-4);
  for (const DepositedBead& b : deposit) EXPECT_EQ(b.bead.position.y(), 0);
}

TEST(MovingCollector, at_no_velocity_changes_no_bit) {
  Scene absent = refined_case(0.8 * cm);
  absent.config.collector->charge = CollectorCharge::grounded;
  Scene zero = absent;
  move_collector(zero, Vec3::Zero());
  for (const char* method : {"dormand-prince", "two-rate"}) {
    absent.config.integrator.method = zero.config.integrator.method = method;
    const auto a = run(absent, 14e-3), b = run(zero, 14e-3);
    EXPECT_GT(a->statistics().landings, 5U);
    EXPECT_EQ(a->jet().y, b->jet().y) << method;
  }
}

TEST(MovingCollector, has_a_budget_that_closes) {
  for (const CollectorCharge charge : {CollectorCharge::grounded, CollectorCharge::kept}) {
    Scene scene = refined_case(0.8 * cm, 1e-3, 1e-7);
    scene.config.collector->charge = charge;
    move_collector(scene, 10 * velocity);
    const FinishedRun run(scene, 12e-3, 3e-3);
    EXPECT_GT(run.simulation->statistics().landings, 5U);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-7);
    EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 1e-7);
  }
}

// scenes/drum.toml: the plate has carried the first beads to y - 2 m/s t.
TEST(MovingCollector, winds_the_fibre_of_the_scene_of_a_drum) {
  const Scene scene = read_scene(EHDJET_SCENES "/drum.toml");
  const auto deposit = deposit_of(scene, 25e-3);
  ASSERT_GE(deposit.size(), 400U);
  double sum = 0, count = 0;
  for (const DepositedBead& b : deposit)
    if (b.time > 20e-3) sum += b.bead.position.y() + 2 * b.time, count += 1;
  EXPECT_LE(std::abs(sum / count), 5e-3); // the middle of the circles in the laboratory
}

// Landings inside macro steps.
TEST(MovingCollector, is_the_same_with_two_rates) {
  Scene scene = refined_case(0.4 * cm, 1e-3, 1e-6);
  scene.config.collector->charge = CollectorCharge::grounded;
  move_collector(scene, velocity);
  const auto one = deposit_of(scene, 13e-3);
  scene.config.integrator.method = "two-rate";
  const auto two = deposit_of(scene, 13e-3);
  ASSERT_GE(one.size(), 30U);
  ASSERT_NEAR(static_cast<double>(one.size()), static_cast<double>(two.size()), 1);
  for (std::size_t i = 0; i < std::min(one.size(), two.size()); ++i) {
    EXPECT_NEAR(one[i].time, two[i].time, 2e-6) << i;
    EXPECT_LE((one[i].bead.position - two[i].bead.position).norm(), 5e-5) << i;
  }
}

} // namespace
} // namespace ehdjet
