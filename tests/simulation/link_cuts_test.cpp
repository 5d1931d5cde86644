#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "support/bookkeeping.hpp"
#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

Scene cut_case(double length, double rtol = 1e-5) {
  Scene s = case_one("dormand-prince", rtol);
  s.config.refinement = RefinementConfig{.length = length, .mesh = RefinedMesh::cut};
  return s;
}

TEST(LinkCuts, keep_links_shorter_than_the_length_but_for_a_step_s_stretch) {
  auto simulation = build_simulation(cut_case(0.4 * cm));
  double longest = 0;
  simulation->after_each_step([&](const Simulation& s) {
    for (std::size_t k = s.jet().first() + 1; k < s.jet().beads(); ++k)
      longest = std::max(longest, link_length(s.jet(), k));
  });
  simulation->run_until(15e-3);
  EXPECT_LE(longest, 0.4 * cm);
  EXPECT_GT(longest, 0.39 * cm);
  EXPECT_GT(simulation->statistics().refinements.value(), 300U);
}

TEST(LinkCuts, happen_at_intervals_if_the_scene_says_so) {
  Scene scene = cut_case(0.4 * cm);
  scene.config.refinement->interval = 1e-3;
  RefinedRun run(scene);
  scene.config.output.refinements = RefinementRecords::sums;
  RefinedRun recorded(scene);
  recorded.simulation->run_until(12e-3);
  EXPECT_LE(recorded.records.size(), 12U);
  ASSERT_GE(recorded.records.size(), 5U);
  for (const RefinementRecord& r : recorded.records) {
    const double ticks = r.time / 1e-3;
    EXPECT_LE(ticks - std::floor(ticks), 0.05) << r.time; // at the first step end behind it
    EXPECT_GT(r.beads_after, r.beads_before);
    EXPECT_LE(std::abs(r.change.mass), 1e-14 * 300 * pvp::mass);
  }
}

TEST(LinkCuts, keep_mass_charge_and_volume) {
  auto simulation = build_simulation(cut_case(0.4 * cm));
  simulation->run_until(15e-3);
  const JetState& jet = simulation->jet();
  const Ledger& ledger = simulation->ledger();
  EXPECT_NEAR((sum_from_one(jet.mass) + ledger.removed_mass) / ledger.inserted_mass, 1,
              1e-13);
  EXPECT_NEAR((sum_from_one(jet.charge) + ledger.removed_charge) / ledger.inserted_charge,
              1, 1e-13);
  EXPECT_NEAR((sum_from_one(jet.volume) + ledger.removed_volume) / ledger.inserted_volume,
              1, 1e-13);
}

// Cuts come at the end of a step, whichever that is: what that does must be small against what the mesh does.
TEST(LinkCuts, do_not_blur_the_trajectory) {
  const auto path_at = [](double rtol) {
    return path_length_of(run(cut_case(0.4 * cm, rtol), 14e-3)->jet());
  };
  const double exact = path_at(1e-8);
  EXPECT_LE(std::abs(path_at(1e-5) / exact - 1), 3e-4);
  EXPECT_LE(std::abs(path_at(1e-6) / exact - 1), 1e-4);
}

} // namespace
} // namespace ehdjet
