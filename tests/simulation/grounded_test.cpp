#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/budgeted.hpp"
#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

// What the reference code prints in the stationary state.
TEST(GroundedCollector, lets_a_straight_jet_land_bead_by_bead) {
  auto simulation = build_simulation(straight_jet());
  double links = 0, looks = 0;
  simulation->add(std::make_unique<Watch>(1e-4, [&](const JetSnapshot& s) {
    if (s.time > 0.4) links += static_cast<double>(s.jet.links()), looks += 1;
  }));
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  simulation->run_until(0.4);
  const std::size_t before = deposit.size();
  simulation->run_until(0.7);
  EXPECT_NEAR(links / looks / 203.99, 1, 1e-3);
  const double beads_per_second = static_cast<double>(deposit.size() - 1 - before)
                                  / (deposit.back().time - deposit[before].time);
  EXPECT_NEAR(beads_per_second * deposit.back().bead.charge / 8.043e-8, 1, 1e-3);
  EXPECT_GT(simulation->statistics().landings, 300U);
  EXPECT_NEAR(simulation->ledger().impact_speed, 16.22, 0.01);
}

TEST(GroundedCollector, changes_the_whipping_jet_a_little) {
  Scene kept = case_one("dormand-prince", 1e-6), grounded = kept;
  grounded.config.collector->charge = CollectorCharge::grounded;
  const auto tip = [](const Scene& scene) {
    std::vector<DepositedBead> deposit;
    auto simulation = build_simulation(scene);
    simulation->add(std::make_unique<Deposit>(deposit));
    simulation->run_until(25e-3);
    double sum = 0, count = 0;
    for (const DepositedBead& b : deposit)
      if (b.time > 15e-3)
        sum += std::hypot(b.bead.position.y(), b.bead.position.z()), count += 1;
    return sum / count;
  };
  const double with = tip(kept), without = tip(grounded);
  EXPECT_NE(with, without);
  EXPECT_NEAR(without / with, 4.4552 / 4.4558, 1e-3);
}

TEST(GroundedCollector, has_a_budget_that_closes) {
  Scene scene = refined_case(0.8 * cm, 1e-3, 1e-7);
  scene.config.collector->charge = CollectorCharge::grounded;
  const FinishedRun run(scene, 12e-3, 3e-3);
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-7);
  EXPECT_GT(run.simulation->statistics().landings, 5U);
}

} // namespace
} // namespace ehdjet
