#include "ehdjet/dynamics/acting_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "support/budgeted.hpp"
#include "support/continued.hpp"
#include "support/pumped.hpp"
#include "support/refined.hpp"

// Jets with image charges in conducting plates (model 3.2).
namespace ehdjet {
namespace {

using namespace test;

Scene grounded(CollectorImages images, double rtol) {
  Scene s = case_one("dormand-prince", rtol);
  s.config.collector->charge = CollectorCharge::grounded;
  s.config.collector->images = images;
  return s;
}

/// A jet that the charge of the nozzle's plate does not hold back.
Scene weakly_charged() {
  Scene s = jet_k(2e-4, 0.4 * cm, 1e-6);
  s.config.refinement.reset();
  s.config.nozzle->charge_density = 1;
  s.config.field->potential = 3e4;
  s.config.collector->distance = 0.03;
  s.config.collector->images = CollectorImages::plates;
  s.config.coulomb->near_field = NearFieldForm::free_surface;
  return s;
}

// By 1 % at 5 cm, 3 % at 12 cm, 6 to 7 % at 15 cm.
TEST(Images, in_the_collector_change_the_field_at_a_whipping_jet_by_some_per_cent) {
  const auto simulation = run(grounded(CollectorImages::collector, 1e-6), 20e-3);
  const JetState& jet = simulation->jet();
  ActingChain chain;
  chain.constrain(simulation->dynamics().constraints());
  chain.bind(jet);
  const Stage& stage = chain.at(jet.time, jet.y);
  const std::size_t n = jet.beads();
  const auto axial = [&](const std::vector<std::string>& names) {
    std::vector<double> x(n), y(n), z(n);
    for (const auto& term : simulation->dynamics().terms())
      if (std::ranges::find(names, term->name()) != names.end())
        term->add_force(stage, {x, y, z});
    return x;
  };
  const auto images = axial({"images", "own images"}),
             others = axial({"Coulomb", "external field"});
  for (const auto& [place, lowest, highest] :
       {std::array{0.05, 0.005, 0.02}, {0.12, 0.02, 0.045}, {0.15, 0.05, 0.08}}) {
    std::vector<double> ratios;
    for (std::size_t k = 2; k < n; ++k)
      if (std::abs(jet.columns().position().x[k] - place) < 0.01)
        ratios.push_back(images[k] / std::abs(others[k]));
    ASSERT_GE(ratios.size(), 3U) << place;
    std::ranges::nth_element(ratios, ratios.begin() + std::ssize(ratios) / 2);
    const double median = ratios[ratios.size() / 2];
    EXPECT_GE(median, lowest) << place;
    EXPECT_LE(median, highest) << place;
  }
}

TEST(Images, have_a_budget_that_closes) {
  for (const Scene& scene :
       {grounded(CollectorImages::collector, 1e-7), weakly_charged()}) {
    const FinishedRun run(scene, 14e-3, 3.5e-3);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-6);
    EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 1e-6);
    EXPECT_LT(run.last().at("image_energy"), 0);
    EXPECT_NE(run.last().at("own_images_work"), 0);
    EXPECT_GT(run.simulation->statistics().landings, 5U);
  }
}

// The point form of its own image would draw a bead in for ever.
TEST(Images, let_beads_land_one_by_one) {
  Scene scene = refined_case(0.4 * cm);
  scene.config.collector->charge = CollectorCharge::grounded;
  scene.config.collector->images = CollectorImages::collector;
  const auto simulation = run(scene, 14e-3);
  EXPECT_GT(simulation->statistics().landings, 30U);
  EXPECT_FALSE(simulation->statistics().two_rates.has_value());
  EXPECT_GT(simulation->ledger().impact_speed, 15);
}

TEST(Images, go_on_from_a_checkpoint_with_the_same_bits) {
  Scene scene = grounded(CollectorImages::collector, 1e-5);
  scene.config.coulomb->solver = "fmm";
  expect_same_bits_after_checkpoints(scene, 5e-3, 12e-3);
}

} // namespace
} // namespace ehdjet
