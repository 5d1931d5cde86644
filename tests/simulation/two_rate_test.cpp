#include "ehdjet/budget/budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "support/case_one.hpp"
#include "support/pumped.hpp"
#include "support/refined.hpp"
#include "support/two_rates.hpp"

// Macro steps with two rates against steps of the whole jet.
namespace ehdjet {
namespace {

using namespace test;

Scene with_method(Scene scene, const std::string& method, double rtol) {
  integrate(scene, method, rtol);
  return scene;
}

// The reference is right to 1e-8 cm. Where the inner beads feel too few of the others directly, the
// error is three times as large.
TEST(TwoRate, every_bead_of_case_one_is_where_the_reference_has_it) {
  Scene scene = case_one("two-rate", 1e-8);
  scene.config.integrator.inner_beads = 24;
  const auto simulation = run(scene, 5e-3);
  EXPECT_EQ(simulation->statistics().method->in_use, "two-rate");
  EXPECT_GT(simulation->statistics().two_rates->steps, 10U);
  const Deviation d = deviation(simulation->jet(), state_at(5));
  EXPECT_LE(d.position, 2.5e-7 * cm);
  EXPECT_LE(d.velocity, 1e-3 * cm);
  // Most of the time up to 5 ms the jet is too short for two rates; from there on it has them.
  const Cost cost = cost_between(*simulation, 5e-3, 9e-3);
  simulation->run_until(10e-3);
  const Deviation later = deviation(simulation->jet(), state_at(10));
  EXPECT_LE(later.position, 2e-6 * cm); // one rate: 1.2e-6
  EXPECT_LE(cost.evaluations, 300);
}

// With refinement and landings: as many beads, landings and refinements, at the same times, for a
// twentieth of the Coulomb sums.
TEST(TwoRate, a_refined_jet_that_lands_is_the_same_jet_for_fewer_sums) {
  const Scene scene = refined_case(0.8 * cm);
  RefinedRun exact(with_method(scene, "dormand-prince", 1e-8));
  exact.simulation->run_until(15e-3);
  RefinedRun two(with_method(scene, "two-rate", 1e-5));
  const Cost cost = cost_between(*two.simulation, 12e-3, 15e-3);
  EXPECT_LE(cost.evaluations, 60);
  EXPECT_LE(cost.full_sums, 95);
  EXPECT_LE(largest_distance(two.simulation->jet(), exact.simulation->jet()), 1e-3 * cm);
  EXPECT_EQ(two.records.size(), exact.records.size());
  ASSERT_EQ(two.deposit.size(), exact.deposit.size());
  ASSERT_GT(two.deposit.size(), 100U);
  std::vector<double> late;
  for (std::size_t i = 0; i < two.deposit.size(); ++i) {
    late.push_back(std::abs(two.deposit[i].time - exact.deposit[i].time));
    EXPECT_NEAR(two.deposit[i].bead.velocity.norm() / exact.deposit[i].bead.velocity.norm(),
                1, 1e-3);
  }
  std::ranges::sort(late);
  EXPECT_LE(late[late.size() / 2], 1e-7);
}

TEST(TwoRate, hardly_depends_on_where_the_jet_is_cut_in_two) {
  Scene scene = with_method(refined_case(0.8 * cm), "two-rate", 1e-5);
  std::vector<JetState> jets;
  for (const std::size_t m : {20U, 24U, 32U}) {
    scene.config.integrator.inner_beads = m;
    jets.push_back(run(scene, 12e-3)->jet());
  }
  EXPECT_LE(largest_distance(jets[0], jets[1]), 3e-4 * cm);
  EXPECT_LE(largest_distance(jets[1], jets[2]), 3e-4 * cm);
}

TEST(TwoRate, takes_more_inner_beads_where_the_first_centimetre_has_more) {
  Scene scene = jet_k(0.01 * cm, 0.4 * cm);
  scene.config.integrator.method = "two-rate";
  const auto simulation = run(scene, 4e-3);
  EXPECT_GE(simulation->statistics().two_rates->inner_beads, 28U);
}

// Mass, charge and volume: what has entered is in the jet or has left it.
void expect_kept_sums(const Simulation& s, double round_off) {
  const auto sum = [](const std::vector<double>& v) {
    double total = 0;
    for (std::size_t k = 1; k < v.size(); ++k) total += v[k];
    return total;
  };
  const Ledger& l = s.ledger();
  const JetState& jet = s.jet();
  EXPECT_NEAR((sum(jet.mass) + l.removed_mass) / l.inserted_mass, 1, round_off);
  EXPECT_NEAR((sum(jet.charge) + l.removed_charge) / l.inserted_charge, 1, round_off);
  EXPECT_NEAR((sum(jet.volume) + l.removed_volume) / l.inserted_volume, 1, round_off);
  EXPECT_EQ(s.statistics().insertions + 1, l.inserted_beads);
}

TEST(TwoRate, keeps_mass_charge_and_volume) {
  const auto jet = run(with_method(refined_case(0.4 * cm), "two-rate", 1e-5), 12e-3);
  ASSERT_GT(jet->ledger().removed_beads, 20U);
  expect_kept_sums(*jet, 1e-13);
  EXPECT_EQ(jet->statistics().releases + (jet->jet().has_embryo ? 1 : 0),
            jet->statistics().insertions);
}

TEST(TwoRate, a_pump_feeds_it_exactly) {
  Scene scene = jet_k(0.01 * cm, 0.4 * cm);
  scene.config.integrator.method = "two-rate";
  const auto two = run(scene, 6e-3);
  ASSERT_GT(two->statistics().two_rates->steps, 20U);
  expect_kept_sums(*two, 1e-13);
  const double start = pvp::radius * pvp::radius * std::numbers::pi * 0.01 * cm / 2;
  EXPECT_NEAR(two->ledger().inserted_volume / (start + 65 * mL_h * 6e-3), 1, 1e-13);
  const auto one = run(with_method(scene, "dormand-prince", 1e-8), 6e-3);
  EXPECT_LE(largest_distance(one->jet(), two->jet()), 1e-4 * cm);
}

TEST(TwoRate, stiff_jets_take_implicit_steps_in_both_parts) {
  Scene scene = refined_case(0.4 * cm);
  scene.config.viscoelasticity = ViscoelasticityConfig{1e8, pvp::viscosity};
  const auto two = run(with_method(scene, "two-rate", 1e-5), 8e-3);
  ASSERT_GT(two->statistics().two_rates->steps, 20U);
  const auto one = run(with_method(scene, "ros34pw2", 1e-7), 8e-3);
  EXPECT_LE(largest_distance(one->jet(), two->jet()), 5e-4 * cm);
  EXPECT_LE(two->statistics().steps, 6000U); // an explicit method would need 1e6
}

// Whoever looks inside macro steps sees the jet with the beads that have been born by then, and
// changes nothing.
TEST(TwoRate, observers_inside_steps_see_the_jet_and_leave_it_alone) {
  const Scene scene = with_method(case_one(), "two-rate", 1e-6);
  const auto alone = run(scene, 11e-3);
  auto watched = build_simulation(scene),
       one = build_simulation(case_one("dormand-prince", 1e-7));
  watched->add(std::make_shared<Budget>(watched->dynamics(), watched->events()));
  std::vector<JetState> seen, expected;
  const auto keep = [](std::vector<JetState>& list, bool counts) {
    return [&list, counts](const JetSnapshot& s) {
      JetState jet = s.jet;
      jet.y.assign(s.columns.flat.begin(), s.columns.flat.end());
      list.push_back(jet);
      if (counts) { // with one rate the ledger waits for the end of the step
        EXPECT_EQ(s.ledger.inserted_beads - s.ledger.removed_beads, jet.links());
      }
    };
  };
  watched->add(std::make_unique<Watch>(0.37e-3, keep(seen, true)));
  one->add(std::make_unique<Watch>(0.37e-3, keep(expected, false)));
  watched->run_until(11e-3), one->run_until(11e-3);
  EXPECT_EQ(watched->jet().y, alone->jet().y);
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].has_embryo, expected[i].has_embryo) << i;
    EXPECT_LE(largest_distance(seen[i], expected[i]), 5e-5 * cm) << i;
  }
}

TEST(TwoRate, the_budget_closes) {
  auto simulation = build_simulation(with_method(refined_case(0.8 * cm), "two-rate", 1e-5));
  auto budget = std::make_shared<Budget>(simulation->dynamics(), simulation->events());
  simulation->add(budget);
  std::vector<double> row(budget->columns().size());
  simulation->add(std::make_unique<Watch>(
      1e-4, [&](const JetSnapshot& s) { budget->measure(s, row); }));
  simulation->run_until(12e-3);
  ASSERT_GT(simulation->statistics().landings, 30U);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string& name = budget->columns()[i].name;
    if (name == "energy_residual_relative" || name == "momentum_residual_relative") {
      EXPECT_LE(std::abs(row[i]), 1e-5) << name;
    } else if (name == "insertion_energy") {
      EXPECT_GT(row[i], 0) << name;
    }
  }
}

/// An event that ends the step that contains a given time, in the middle of it.
class Stop final : public Event {
public:
  Stop(double time, int& happened)
      : time_(time)
      , happened_(happened) {}
  [[nodiscard]] std::string_view name() const override { return "stop"; }
  [[nodiscard]] bool due(const JetState& /*jet*/) const override { return false; }
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override {
    const double theta = (time_ - step.t0) / step.h;
    return theta > 0 && theta <= 1 ? std::optional(theta) : std::nullopt;
  }
  [[nodiscard]] std::optional<double> predict(const DenseStep& /*step*/) const override {
    return {};
  }
  void apply(EventContext& context) override {
    EXPECT_NEAR(context.jet.time, time_, 1e-15);
    ++happened_;
  }

private:
  double time_;
  int& happened_;
};

// The macro step is taken again up to the event, and only the last micro step of the inner beads.
TEST(TwoRate, an_event_inside_a_macro_step_ends_it) {
  const Scene scene = with_method(case_one(), "two-rate", 1e-6);
  int happened = 0;
  Extras extras;
  for (const double t : {5.03e-3, 5.5e-3, 5.5031e-3})
    extras.events.push_back(std::make_unique<Stop>(t, happened));
  auto stopped = build_simulation(scene, std::move(extras));
  stopped->run_until(6e-3);
  EXPECT_EQ(happened, 3);
  EXPECT_LE(largest_distance(stopped->jet(), run(scene, 6e-3)->jet()), 2e-5 * cm);
}

// Landed beads act on no other bead there. With a collector at 4 cm the inner beads notice.
TEST(TwoRate, converges_with_the_tolerance_above_a_grounded_collector_nearby) {
  Scene scene = refined_case(0.1 * cm);
  scene.config.collector = CollectorConfig{.distance = 4 * cm};
  scene.config.field =
      FieldConfig{.potential = {}, .strength = pvp::potential / pvp::distance};
  const auto exact = run(with_method(scene, "dormand-prince", 1e-9), 5.5e-3);
  ASSERT_GT(exact->statistics().landings, 20U);
  double before = 0;
  for (const double rtol : {1e-5, 1e-7}) {
    const auto two = run(with_method(scene, "two-rate", rtol), 5.5e-3);
    EXPECT_GT(two->statistics().two_rates->steps, 5U);
    EXPECT_EQ(two->statistics().landings, exact->statistics().landings);
    const double error = largest_distance(two->jet(), exact->jet());
    EXPECT_LE(error, 2e-4 * cm);
    if (before > 0) {
      EXPECT_LE(error, before / 4);
    }
    before = error;
  }
}

// What has passed the collector is softened no longer for those that have not.
TEST(TwoRate, softened_pairs_end_at_the_collector) {
  Scene scene = jet_k(0.02 * cm, 0.2 * cm);
  const auto end = [&](const std::string& method, double rtol) {
    return run(with_method(scene, method, rtol), 13e-3);
  };
  const auto exact = end("dormand-prince", 1e-8), two = end("two-rate", 1e-6);
  ASSERT_GT(exact->statistics().landings, 20U);
  ASSERT_GT(two->statistics().two_rates->steps, 20U);
  EXPECT_LE(largest_distance(two->jet(), exact->jet()), 2e-4 * cm);
}

TEST(TwoRate, every_third_bead_is_an_impurity_also_after_rejected_steps) {
  Scene scene = case_one();
  scene.config.varicosity =
      VaricosityConfig{.every = 3, .factor = 1.3, .mass = true, .volume = true};
  const auto one = run(with_method(scene, "dormand-prince", 1e-6), 12e-3),
             two = run(with_method(scene, "two-rate", 1e-5), 12e-3);
  ASSERT_GT(two->statistics().rejected, 0U);
  EXPECT_EQ(two->ledger().inserted_beads, one->ledger().inserted_beads);
  EXPECT_EQ(two->jet().mass, one->jet().mass);
}

TEST(TwoRate, no_step_is_longer_than_it_may_be) {
  Scene scene = with_method(refined_case(0.4 * cm), "two-rate", 1e-4);
  scene.config.integrator.max_step = 7e-5;
  EXPECT_LE(run(scene, 6e-3)->statistics().longest_step, 7e-5 * (1 + 1e-12));
}

// Around the number of beads from which on there are two rates.
TEST(TwoRate, a_short_jet_changes_to_and_fro) {
  Scene scene = refined_case(0.4 * cm);
  scene.config.collector = CollectorConfig{.distance = 3 * cm};
  scene.config.field =
      FieldConfig{.potential = {}, .strength = pvp::potential / pvp::distance};
  scene.config.integrator.method = "two-rate";
  scene.config.integrator.inner_beads = 28;
  const auto two = run(scene, 12e-3);
  ASSERT_GT(two->ledger().removed_beads, 20U);
  expect_kept_sums(*two, 1e-12);
  const auto one = run(with_method(scene, "dormand-prince", 1e-8), 12e-3);
  EXPECT_LE(largest_distance(two->jet(), one->jet()), 1e-3 * cm);
}

TEST(TwoRate, auto_chooses_it_once_the_jet_is_long_enough) {
  const auto simulation = run(with_method(refined_case(0.2 * cm), "auto", 1e-5), 8e-3);
  const RunStatistics& s = simulation->statistics();
  EXPECT_EQ(s.method->in_use, "two-rate");
  EXPECT_EQ(s.method->changes, 1U);
  // Of other scenes it knows nothing.
  Scene stretched = case_one("auto", 1e-5);
  stretched.config.coulomb.reset();
  EXPECT_FALSE(run(stretched, 1e-4)->statistics().two_rates);
  EXPECT_FALSE(run(case_one("dormand-prince", 1e-5), 1e-4)->statistics().two_rates);
}

} // namespace
} // namespace ehdjet
