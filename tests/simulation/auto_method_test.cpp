#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

Scene jet_of(double modulus, double viscosity, const std::string& method,
             double rtol_or_step) {
  Scene scene = case_one(method, rtol_or_step);
  scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
  return scene;
}

TEST(AutoMethod, case_one_is_computed_by_the_explicit_pair_to_the_last_bit) {
  for (const double rtol : {1e-4, 1e-6}) {
    const auto chosen = run(case_one("auto", rtol), 2e-3);
    const auto named = run(case_one("dormand-prince", rtol), 2e-3);
    EXPECT_EQ(chosen->jet().y, named->jet().y);
    EXPECT_EQ(chosen->statistics().evaluations, named->statistics().evaluations);
    EXPECT_EQ(chosen->statistics().rejected, named->statistics().rejected);
    EXPECT_EQ(chosen->statistics().method->in_use, "dormand-prince");
    EXPECT_EQ(chosen->statistics().method->changes, 0U);
    EXPECT_FALSE(named->statistics().method);
  }
}

// A jet of ten thousand million pascals, one that relaxes within a picosecond, and a solid thread:
// the explicit pair would take 4e5, 1e9 and 1e4 steps.
TEST(AutoMethod, carries_jets_that_no_explicit_method_could) {
  struct Row {
    double modulus, viscosity;
    std::size_t least_beads;
  };
  for (const auto& [modulus, viscosity, least_beads] :
       {Row{1e9, 2, 15}, {1e9, 1e-3, 20}, {1e9, 1e4, 2}}) {
    const auto simulation = run(jet_of(modulus, viscosity, "auto", 1e-4), 2e-3);
    const RunStatistics& cost = simulation->statistics();
    EXPECT_EQ(cost.method->in_use, "ros34pw2") << modulus << " " << viscosity;
    EXPECT_LE(cost.steps, 1000U) << modulus << " " << viscosity;
    EXPECT_GE(simulation->jet().beads(), least_beads) << modulus << " " << viscosity;
    // The same jet again has the same bits, and a tighter tolerance nearly the same place.
    EXPECT_EQ(run(jet_of(modulus, viscosity, "auto", 1e-4), 2e-3)->jet().y,
              simulation->jet().y);
    const auto finer = run(jet_of(modulus, viscosity, "auto", 1e-6), 2e-3);
    ASSERT_EQ(finer->jet().beads(), simulation->jet().beads());
    const std::size_t tip = finer->jet().links();
    EXPECT_LE((finer->jet().columns().position()[tip]
               - simulation->jet().columns().position()[tip])
                  .norm(),
              0.1 * pvp::link_length)
        << modulus << " " << viscosity;
  }
}

TEST(AutoMethod, observers_do_not_change_a_stiff_jet) {
  const Scene scene = jet_of(1e9, 2, "auto", 1e-4);
  auto watched = build_simulation(scene);
  int looks = 0;
  watched->add(std::make_unique<Watch>(1.3e-5, [&](const JetSnapshot&) { ++looks; }));
  watched->run_until(1e-3);
  EXPECT_GT(looks, 70);
  EXPECT_EQ(watched->jet().y, run(scene, 1e-3)->jet().y);
}

/// Observed order of a stiff jet at its end over fixed steps.
double order_of_stiff_jet(double end, double angular_frequency, std::size_t beads) {
  const auto jet = [&](double step) {
    Scene scene = jet_of(1e9, 2, "ros34pw2", 1e-6);
    scene.config.nozzle->amplitude = pvp::link_length;
    scene.config.nozzle->angular_frequency = angular_frequency;
    integrate_with_fixed_steps(scene, "ros34pw2", step);
    return run(scene, end)->jet();
  };
  const JetState exact = jet(2e-8);
  EXPECT_EQ(exact.beads(), beads);
  std::vector<double> steps, errors;
  for (const double step : {2e-6, 1.41e-6, 1e-6, 7.1e-7, 5e-7}) {
    const JetState j = jet(step);
    EXPECT_EQ(j.beads(), exact.beads());
    if (j.beads() != exact.beads()) return std::nan("");
    double worst = 0;
    for (std::size_t k = 0; k < j.beads(); ++k)
      worst = std::max(worst,
                       (j.columns().position()[k] - exact.columns().position()[k]).norm());
    steps.push_back(step), errors.push_back(worst);
  }
  return observed_order(steps, errors);
}

// The stress of the first link answers at once to a nozzle that moves: without the derivative in
// time, which is in J times the nozzle's acceleration, second order would be left.
TEST(StiffJet, converges_at_third_order_though_its_nozzle_moves) {
  EXPECT_NEAR(order_of_stiff_jet(5e-5, 1e5, 2), 3, 0.2);
}

// An insertion changes no stress. A release halves the length of a link that keeps its stress,
// which a stiff fluid forgets at once; within the step that sees this one order is lost.
TEST(StiffJet, converges_across_insertions_and_releases) {
  EXPECT_NEAR(order_of_stiff_jet(5e-5, 1e4, 3), 3, 0.2);
  EXPECT_NEAR(order_of_stiff_jet(1.4e-4, 1e4, 3), 2, 0.2);
}

// Linear stability: a straight chain of 50 beads, neither charge nor viscosity, and noise.
double growth(double modulus, double viscosity, double share) {
  Scene scene = chain_scene(FixedEnds::both);
  for (std::size_t k = 0; k < 50; ++k) {
    Bead bead = pvp_bead({static_cast<double>(k) * pvp::link_length, 0, 0});
    bead.charge = 0;
    bead.velocity.x() = 1e-9 * std::sin(12.9 * static_cast<double>(k * k));
    add_bead(scene, bead);
  }
  scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
  const double limit = step_limits(chain_rates(scene.config, link_state(scene, 1))).least();
  integrate_with_fixed_steps(scene, "rk4", share * limit);
  const auto size = [&](double end) {
    std::unique_ptr<Simulation> simulation;
    try {
      simulation = run(scene, end);
    } catch (const RunError&) { // beads run into each other
      return 1.0;
    }
    double largest = 0;
    for (const double v : simulation->jet().columns().velocity().x)
      largest = std::max(largest, std::abs(v));
    return largest;
  };
  return size(2000 * share * limit) / size(share * limit);
}

TEST(StabilityLimits, of_rk4_are_where_the_formulas_say) {
  for (const auto& [modulus, viscosity] :
       {std::pair{5e3, 1e6}, {1e9, 2.0}, {5e4, 1e-3}, {5e3, 0.25}}) {
    EXPECT_LE(growth(modulus, viscosity, 0.95), 3) << modulus << " " << viscosity;
    EXPECT_GE(growth(modulus, viscosity, 1.05), 1e3) << modulus << " " << viscosity;
  }
}

} // namespace
} // namespace ehdjet
