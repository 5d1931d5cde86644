#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/bookkeeping.hpp"
#include "support/case_one.hpp"
#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

TEST(RefinedJet, is_bit_identical_to_the_unrefined_one_while_no_link_is_too_long) {
  const auto plain = run(case_one("dormand-prince", 1e-5), 3e-3);
  const auto refined = run(refined_case(1.0, 1e-5), 3e-3);
  EXPECT_EQ(refined->jet().y, plain->jet().y);
  EXPECT_EQ(refined->statistics().evaluations, plain->statistics().evaluations);
  EXPECT_EQ(refined->statistics().refinements, std::nullopt);
}

TEST(RefinedJet, is_cut_at_exact_multiples_of_the_interval) {
  for (const double interval : {1e-3, 0.7e-3}) {
    RefinedRun run(refined_case(0.4 * cm, interval));
    run.simulation->run_until(8e-3);
    ASSERT_GE(run.records.size(), 4U);
    for (const RefinementRecord& r : run.records) {
      const double multiple = std::round(r.time / interval);
      EXPECT_EQ(r.time, multiple * interval);
      EXPECT_GT(r.beads_after, r.beads_before);
    }
    EXPECT_EQ(run.simulation->statistics().refinements, run.records.size());
  }
}

TEST(RefinedJet, is_cut_at_the_end_of_a_run_too_and_with_fixed_steps_and_snapped_events) {
  Scene fixed = refined_case(0.4 * cm);
  integrate_with_fixed_steps(fixed, "rk4", 1e-6);
  for (const auto placement : {EventPlacement::located, EventPlacement::step_end}) {
    fixed.config.integrator.events = placement;
    RefinedRun run(fixed);
    run.simulation->run_until(4e-3);
    ASSERT_FALSE(run.records.empty());
    EXPECT_NEAR(run.records.back().time, 4e-3, 1e-15);
    EXPECT_EQ(run.records.back().beads_after, run.simulation->jet().beads());
  }
}

// 200 refinements, landings of refined links included.
TEST(RefinedJet, keeps_mass_charge_and_volume) {
  for (const auto remap : {LinkRemap::conservative, LinkRemap::paper}) {
    Scene scene = refined_case(0.8 * cm, 3e-5, 1e-4);
    scene.config.refinement->remap = remap;
    RefinedRun run(scene);
    run.simulation->run_until(14e-3);
    EXPECT_GE(run.records.size(), 200U);
    const JetState& jet = run.simulation->jet();
    const Ledger& ledger = run.simulation->ledger();
    EXPECT_GT(ledger.removed_beads, 100U);
    const double bound = 1e-12;
    EXPECT_NEAR((sum_from_one(jet.mass) + ledger.removed_mass) / ledger.inserted_mass, 1,
                bound);
    EXPECT_NEAR((sum_from_one(jet.charge) + ledger.removed_charge) / ledger.inserted_charge,
                1, bound);
    EXPECT_NEAR((sum_from_one(jet.volume) + ledger.removed_volume) / ledger.inserted_volume,
                1, bound);
    for (const RefinementRecord& r : run.records) {
      EXPECT_LE(std::abs(r.change.mass), 1e-14 * ledger.inserted_mass);
      EXPECT_LE(std::abs(r.change.charge), 1e-14 * ledger.inserted_charge);
      EXPECT_LE(std::abs(r.change.volume), 1e-14 * ledger.inserted_volume);
    }
  }
}

// Beads land, are put on the plane and leave while the mesh changes; none is lost or stays behind.
TEST(RefinedJet, deposits_beads_on_the_collector_in_the_order_in_which_they_land) {
  RefinedRun run(refined_case(0.4 * cm));
  run.simulation->run_until(14e-3);
  ASSERT_GT(run.deposit.size(), 100U);
  for (std::size_t i = 0; i < run.deposit.size(); ++i) {
    const DepositedBead& b = run.deposit[i];
    EXPECT_EQ(b.bead.position.x(), pvp::distance);
    EXPECT_LE(b.time, b.removal_time);
    EXPECT_GT(b.radius, 0);
    EXPECT_GT(b.bead.mass, 0);
    if (i == 0) continue;
    EXPECT_LE(run.deposit[i - 1].removal_time, b.removal_time);
  }
  const JetState& jet = run.simulation->jet();
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    EXPECT_LE(jet.columns().position().x[k], pvp::distance);
    EXPECT_EQ(jet.is_landed(k), jet.columns().position().x[k] == pvp::distance) << k;
  }
}

TEST(RefinedJet, converges_with_the_tolerance_like_an_unrefined_one) {
  const auto slope = [](bool refined) {
    const auto path = [refined](double rtol) {
      Scene scene = refined_case(0.4 * cm, 1e-3, rtol);
      if (!refined) {
        scene.config.refinement.reset();
        scene.config.output.refinements = RefinementRecords::none;
      }
      return path_length_of(run(scene, 8e-3)->jet());
    };
    const double exact = path(1e-9);
    std::vector<double> rtol{1e-4, 1e-5, 1e-6}, error;
    for (const double r : rtol) error.push_back(std::abs(path(r) - exact));
    return observed_order(rtol, error);
  };
  const double unrefined = slope(false);
  EXPECT_NEAR(unrefined, 1, 0.15);
  EXPECT_NEAR(slope(true), unrefined, 0.1);
}

// A jet without forces whose velocity is linear along it: Akima's curve is exact, and every link
// has the same strain rate.
TEST(RefinedJet, does_not_feel_the_refinement_of_a_uniformly_stretching_jet) {
  constexpr double rate = 300, spacing = 1e-3;
  Scene scene = chain_scene();
  for (int k = 0; k <= 20; ++k)
    add_bead(scene, {.position = {k * spacing, 0, 0},
                     .velocity = {rate * k * spacing, 0, 0},
                     .volume = 1e-25, // no force to speak of
                     .mass = 1e-9,
                     .charge = 0,
                     .declared = {2e3}});
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  const auto plain = run(scene, 5e-3);
  scene.config.refinement = RefinementConfig{.length = 1.2e-3, .interval = 4e-4};
  const auto refined = run(scene, 5e-3);
  ASSERT_GT(refined->jet().links(), 40U);
  EXPECT_GE(refined->statistics().refinements.value_or(0), 5U);
  EXPECT_NEAR(path_length_of(refined->jet()) / path_length_of(plain->jet()), 1, 1e-12);
  const double stress = stress_of(plain->jet().columns())[1];
  const auto refined_stress = stress_of(refined->jet().columns());
  for (std::size_t k = 1; k < refined->jet().beads(); ++k)
    EXPECT_NEAR(refined_stress[k] / stress, 1, 1e-12) << k;
}

TEST(RefinedJet, is_resolved_right_after_a_refinement) {
  constexpr double length = 0.2 * cm;
  RefinedRun run(refined_case(length));
  double least = 1e300;
  run.simulation->add(std::make_unique<Watch>(1e-3, [&](const JetSnapshot& s) {
    if (run.records.empty() || run.records.back().time != s.time) return;
    for (int i = 0; i <= 1000; ++i)
      least = std::min(least, resolving_power(s.jet, s.columns.position(), i / 1000.0));
  }));
  run.simulation->run_until(9e-3);
  ASSERT_GE(run.records.size(), 5U);
  double worst_link = 0;
  for (const RefinementRecord& r : run.records)
    worst_link = std::max(worst_link, r.worst_link);
  EXPECT_LE(worst_link, 0.2); // chords against arcs of a coarse coil
  EXPECT_GE(least, 0.1 / (1 + worst_link));
}

TEST(RefinedJet, records_what_each_refinement_changes) {
  Scene scene = refined_case(0.4 * cm);
  scene.config.output.refinements = RefinementRecords::energies;
  RefinedRun run(scene);
  run.simulation->run_until(6e-3);
  ASSERT_GE(run.records.size(), 3U);
  for (const RefinementRecord& r : run.records) {
    EXPECT_GT(r.kept, 10U);
    EXPECT_LT(r.kept, r.beads_before);
    EXPECT_GT(r.change.coulomb_energy, 0); // the same charge in more pieces
    EXPECT_NE(r.change.kinetic_energy, 0);
    EXPECT_NE(r.change.elastic_energy, 0);
    EXPECT_GT(r.worst_link, 0);
  }
  scene.config.output.refinements = RefinementRecords::none;
  RefinedRun silent(scene);
  silent.simulation->run_until(6e-3);
  EXPECT_TRUE(silent.records.empty());
  EXPECT_EQ(silent.simulation->jet().y, run.simulation->jet().y);
}

TEST(RefinedJet, keeps_momentum_if_asked_to) {
  Scene scene = refined_case(0.4 * cm);
  scene.config.refinement->velocity = ColumnRemap::conservative;
  scene.config.refinement->stress = ColumnRemap::conservative;
  RefinedRun run(scene);
  run.simulation->run_until(6e-3); // nothing has landed
  ASSERT_GE(run.records.size(), 3U);
  const double momentum = run.simulation->ledger().inserted_mass * 10; // at 10 m/s
  for (const RefinementRecord& r : run.records) {
    EXPECT_LE(r.change.momentum.norm(), 1e-14 * momentum);
    EXPECT_LE(r.change.kinetic_energy, 0);
    EXPECT_LE(r.change.elastic_energy, 0);
  }
}

TEST(VaricoseJet, has_heavier_beads_at_regular_places) {
  Scene scene = case_one("dormand-prince", 1e-5);
  scene.config.varicosity = VaricosityConfig{.every = 10, .factor = 1.1};
  const auto simulation = run(scene, 4e-3);
  const JetState& jet = simulation->jet();
  ASSERT_GT(jet.links(), 40U);
  ASSERT_EQ(simulation->ledger().removed_beads, 0U);
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    const std::size_t birth = jet.beads() - k; // the bead of the start is the first
    const double factor = birth % 10 == 0 ? 1.1 : 1;
    EXPECT_DOUBLE_EQ(jet.mass[k], factor * pvp::mass) << k;
    EXPECT_DOUBLE_EQ(jet.volume[k], factor * pvp::volume) << k;
    EXPECT_DOUBLE_EQ(jet.charge[k], pvp::charge) << k;
  }
  scene.config.varicosity = VaricosityConfig{
      .every = 3, .factor = 2, .mass = true, .volume = false, .charge = true};
  const JetState other = run(scene, 1e-3)->jet();
  for (std::size_t k = 1; k < other.beads(); ++k) {
    const double factor = (other.beads() - k) % 3 == 0 ? 2 : 1;
    EXPECT_DOUBLE_EQ(other.mass[k], factor * pvp::mass);
    EXPECT_DOUBLE_EQ(other.volume[k], pvp::volume);
    EXPECT_DOUBLE_EQ(other.charge[k], factor * pvp::charge);
  }
}

/// How two runs of the same jet differ in what they deposit.
struct DepositDifference {
  double place = 0, time = 0, velocity = 0, stress = 0, radius = 0;
  DepositDifference(const RefinedRun& a, const RefinedRun& b) {
    EXPECT_NEAR(static_cast<double>(a.deposit.size()),
                static_cast<double>(b.deposit.size()), 1);
    for (std::size_t i = 0; i < std::min(a.deposit.size(), b.deposit.size()); ++i) {
      const DepositedBead &p = a.deposit[i], &q = b.deposit[i];
      place = larger(place, (p.bead.position - q.bead.position).norm());
      time = larger(time, std::abs(p.time - q.time));
      velocity = larger(velocity, (p.bead.velocity - q.bead.velocity).norm());
      stress = larger(stress, std::abs(stress_of(p.bead) - stress_of(q.bead)));
      radius = larger(radius, std::abs(p.radius / q.radius - 1));
    }
  }
};

// While landings are rare, each one ends a step. When they are frequent, steps go on through them, and
// the place, time and state of each landing are the same within the tolerance.
TEST(FrequentLandings, do_not_end_steps_and_are_as_exact) {
  const auto finish = [](LandingSteps landings, double rtol) {
    Scene scene = refined_case(0.41 * cm, 1e-3, rtol); // no tie of a ceil among the three
    scene.config.integrator.landings = landings;
    auto run = std::make_unique<RefinedRun>(scene);
    run->simulation->run_until(13.9e-3);
    return run;
  };
  const auto exact = finish(LandingSteps::located, 1e-7);
  const auto each = finish(LandingSteps::located, 1e-5);
  const auto through = finish(LandingSteps::automatic, 1e-5);
  EXPECT_FALSE(each->simulation->jet().absorbing_plane);
  EXPECT_TRUE(through->simulation->jet().absorbing_plane);
  const RunStatistics &n = each->simulation->statistics(),
                      &m = through->simulation->statistics();
  EXPECT_LT(static_cast<double>(m.evaluations), 0.95 * static_cast<double>(n.evaluations));

  ASSERT_GT(exact->deposit.size(), 100U);
  const DepositDifference located(*each, *exact), passed(*through, *exact);
  EXPECT_LE(passed.place, 1.5 * located.place);
  EXPECT_LE(passed.time, 1.5 * located.time);
  EXPECT_LE(passed.velocity, 1.5 * located.velocity);
  EXPECT_LE(passed.stress, 1.5 * located.stress);
  EXPECT_LE(passed.radius, 1.5 * located.radius);
  EXPECT_LE(located.place, 2e-3 * cm);
}

TEST(FrequentLandings, look_complete_between_steps) {
  RefinedRun run(refined_case(0.4 * cm));
  double furthest = 0;
  std::size_t jumps = 0, before = 0;
  run.simulation->add(std::make_unique<Watch>(1e-6, [&](const JetSnapshot& s) {
    if (s.time < 11e-3) return;
    furthest = std::max(furthest, *std::ranges::max_element(s.columns.position().x));
    EXPECT_EQ(s.columns.beads, s.jet.beads());
    EXPECT_LE(s.jet.landed.size(), 2U);
    if (before > s.jet.beads() + 1) ++jumps; // two at once are rare within a microsecond
    before = s.jet.beads();
  }));
  run.simulation->run_until(12e-3);
  EXPECT_EQ(furthest, pvp::distance);
  EXPECT_LE(jumps, 3U);
}

} // namespace
} // namespace ehdjet
