#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double stationary = 30e-3;

double mean_beads_before(const RefinedRun& run) {
  double sum = 0, count = 0;
  for (const RefinementRecord& r : run.records)
    if (r.time >= stationary) sum += static_cast<double>(r.beads_before), count += 1;
  return sum / count;
}

// Counted right before the refinements; an independent program has 267, 485.
TEST(Table2, stationary_bead_counts_are_those_of_the_paper_s_remap) {
  Scene scene = refined_case(0.8 * cm);
  scene.config.refinement->remap = LinkRemap::paper;
  RefinedRun coarse(scene);
  coarse.simulation->run_until(45e-3);
  EXPECT_NEAR(mean_beads_before(coarse) / 267, 1, 0.03);
  scene.config.refinement->length = 0.4 * cm;
  RefinedRun fine(scene);
  fine.simulation->run_until(45e-3);
  EXPECT_NEAR(mean_beads_before(fine) / 485, 1, 0.03);
}

// Time means of l_step/l along the jet.
std::vector<double> mean_power(const Scene& scene, double end, double from, int places) {
  std::vector<double> sum(static_cast<std::size_t>(places + 1), 0.0);
  double samples = 0;
  auto simulation = build_simulation(scene);
  simulation->add(std::make_unique<Watch>(1e-4, [&](const JetSnapshot& s) {
    if (s.time < from) return;
    samples += 1;
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += resolving_power(s.jet, s.columns.position(),
                                static_cast<double>(i) / static_cast<double>(places));
  }));
  simulation->run_until(end);
  for (double& r : sum) r /= samples;
  return sum;
}

TEST(ResolvingPower,
     of_case_one_falls_to_a_fortieth_and_to_less_than_a_hundred_and_sixtieth) {
  const auto r = mean_power(case_one("dormand-prince", 1e-5), 60e-3, 35e-3, 10);
  EXPECT_NEAR(r[1] * 40, 1, 0.25);
  EXPECT_LE(r[10], 1.0 / 160);
  EXPECT_GE(r[10], 1.0 / 210);
}

TEST(ResolvingPower, of_a_jet_refined_at_2_mm_stays_above_seven_hundredths_on_average) {
  const auto r = mean_power(refined_case(0.2 * cm), 26e-3, 18e-3, 50);
  EXPECT_GE(*std::ranges::min_element(r), 0.07);
}

// A refinement may end a step in which, further on, a landing was located.
TEST(FrequentLandings, lead_to_the_same_jet_as_those_that_end_steps) {
  Scene scene = refined_case(0.4 * cm, 1e-3, 1e-6);
  for (const LinkRemap remap : {LinkRemap::conservative, LinkRemap::paper}) {
    scene.config.refinement->remap = remap;
    scene.config.integrator.landings = LandingSteps::automatic;
    const auto passing = run(scene, 14.5e-3);
    scene.config.integrator.landings = LandingSteps::located;
    const auto located = run(scene, 14.5e-3);
    EXPECT_LE(largest_distance(passing->jet(), located->jet()), 1e-5);
  }
}

// Four times the beads, four times the landings, the same number of steps.
TEST(FrequentLandings, do_not_set_the_pace) {
  const auto evaluations = [](double length) {
    RefinedRun run(refined_case(length));
    run.simulation->run_until(14e-3);
    const auto before = run.simulation->statistics().evaluations;
    run.simulation->run_until(17e-3);
    return static_cast<double>(run.simulation->statistics().evaluations - before);
  };
  EXPECT_NEAR(evaluations(0.2 * cm) / evaluations(0.8 * cm), 1, 0.15);
}

} // namespace
} // namespace ehdjet
