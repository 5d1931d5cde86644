#include "ehdjet/core/error.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/budgeted.hpp"
#include "support/refined.hpp"

// Cases at or beyond the edge of the model: a run gives the right jet, or ends with a message;
// never a NaN.
namespace ehdjet {
namespace {

using namespace test;

void expect_finite(const JetState& jet) {
  for (const double v : jet.y) ASSERT_TRUE(std::isfinite(v)) << jet.time;
}

/// The message with which a run ends.
std::string failure(const Scene& scene, double end_time) {
  const auto simulation = build_simulation(scene);
  try {
    simulation->run_until(end_time);
  } catch (const RunError& e) {
    expect_finite(simulation->jet());
    return e.what();
  }
  ADD_FAILURE() << "ran to " << simulation->jet().time;
  return "";
}
void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos)
        << "no `" << part << "` in: " << message;
}

// ---- fluids -----------------------------------------------------------------------------------

// tau = mu/G would be 0/0.
TEST(ExtremeFluid, without_elasticity_or_viscosity_is_inviscid) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.viscoelasticity.reset();
  const auto inviscid = run(scene, 1e-3);
  const std::pair<double, double> fluids[] = {
      {0, pvp::viscosity}, {pvp::modulus, 0}, {0, 0}};
  for (const auto& [modulus, viscosity] : fluids) {
    scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
    const auto simulation = run(scene, 1e-3);
    EXPECT_FALSE(has_stress(simulation->jet().columns()));
    EXPECT_EQ(simulation->jet().y, inviscid->jet().y) << modulus << ' ' << viscosity;
    expect_finite(simulation->jet());
  }
}

// Compressed beads push: a chain that is not quite straight buckles, and its energy adds up.
TEST(ExtremeFluid, under_compression_buckles) {
  Scene scene = chain_scene(FixedEnds::none);
  for (int k = 0; k <= 20; ++k) {
    Bead bead = pvp_bead({k * pvp::link_length, k % 2 == 0 ? 1e-9 : -1e-9, 0});
    bead.declared = {-2e4};
    add_bead(scene, bead);
  }
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  integrate(scene, "dop853", 1e-9);
  const FinishedRun run(scene, 1e-4, 1e-5);
  expect_finite(run.simulation->jet());
  double widest = 0, least = 0;
  const auto c = run.simulation->jet().columns();
  for (std::size_t k = 0; k <= 20; ++k) {
    widest = std::max(widest, std::abs(c.position().y[k]));
    if (k > 0) least = std::min(least, stress_of(c)[k]);
  }
  EXPECT_GT(widest, 5e-9);
  EXPECT_LT(least, -1e3);
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-9);
}

// ---- links that vanish, beads that meet ---------------------------------------------------------

/// A chain at rest of whose beads one flies into its upstream neighbour.
Scene rear_end_collision(double speed) {
  Scene scene = chain_scene();
  for (int k = 0; k < 6; ++k)
    add_bead(scene, pvp_bead({k * pvp::link_length, 0, 0}, {k == 3 ? -speed : 0, 0, 0}));
  return scene;
}

TEST(VanishingLink, ends_the_run_with_bead_time_term_and_advice) {
  for (const std::string method : {"dormand-prince", "dop853", "rk4"}) {
    Scene scene = rear_end_collision(100);
    scene.config.viscoelasticity = ViscoelasticityConfig{1, 1e-3};
    integrate(scene, method, method == "rk4" ? 1e-8 : 1e-5);
    const double collision = pvp::link_length / 100;
    const std::string message = failure(scene, 2 * collision);
    expect_parts(message, {"t = ", "bead 3", "bead 2", "link", "viscoelasticity",
                           "refinement.coarsen"});
    auto simulation = build_simulation(scene);
    EXPECT_THROW(simulation->run_until(2 * collision), RunError);
    EXPECT_NEAR(simulation->jet().time / collision, 1, 0.05) << method;
    EXPECT_GT(link_length(simulation->jet(), 3), 0) << method; // has not passed through
  }
}

TEST(VanishingLink, is_none_where_the_repulsion_turns_the_bead_back) {
  Scene scene = rear_end_collision(30);
  scene.config.coulomb = CoulombConfig{};
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  integrate(scene, "dop853", 1e-10);
  const FinishedRun run(scene, 1e-4, 1e-6);
  expect_finite(run.simulation->jet());
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-8);
}

TEST(VanishingLink, does_not_matter_to_beads_without_forces_between_them) {
  const auto simulation = run(rear_end_collision(100), 1e-5);
  EXPECT_NEAR(simulation->jet().columns().position().x[3],
              3 * pvp::link_length - 100 * 1e-5, 1e-15);
}

// Two strands of one chain that cross: beads that are no neighbours come within a twentieth of a
// link.
TEST(CrossingLoops, are_resolved_by_the_steps) {
  Scene scene = chain_scene();
  constexpr int half = 10;
  const double l = pvp::link_length, gap = 8 * l, speed = 40;
  for (int k = 0; k < half; ++k) add_bead(scene, pvp_bead({k * l, 0, 0}, {0, speed, 0}));
  for (int k = 1; k < 8; ++k) add_bead(scene, pvp_bead({half * l, k * gap / 8, 0}));
  for (int k = half - 1; k >= 0; --k)
    add_bead(scene, pvp_bead({k * l, gap, 0.05 * l}, {0, -speed, 0}));
  scene.config.coulomb = CoulombConfig{};
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  scene.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension,
                                                      .form = SurfaceTensionForm::line};
  for (const std::string method : {"dormand-prince", "dop853"}) {
    integrate(scene, method, 1e-11);
    BudgetedRun run(scene, 1e-6);
    double nearest = 1;
    run.simulation->after_each_step([&](const Simulation& s) {
      const auto r = s.jet().columns().position();
      for (std::size_t i = 0; i < 10; ++i)
        for (std::size_t j = 17; j < r.size(); ++j)
          nearest = std::min(nearest, (r[i] - r[j]).norm());
    });
    run.simulation->run_until(4e-5);
    EXPECT_LT(nearest, 0.07 * l) << method;
    const auto y = run.simulation->jet().columns().position().y;
    EXPECT_GT(y[3], y[23]) << method; // have passed
    EXPECT_LE(run.worst(), 1e-8 * run.rows.front().at("coulomb_energy")) << method;
  }
}

// ---- charges, fields, scales ----------------------------------------------------------------

TEST(ExtremeCharge, of_zero_is_the_same_as_no_coulomb_term_with_every_solver) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.nozzle->charge_density = 0;
  scene.config.coulomb.reset();
  const auto without = run(scene, 5e-3);
  for (const std::string solver : {"direct", "treecode", "fmm", "auto"}) {
    scene.config.coulomb = CoulombConfig{.solver = solver};
    EXPECT_EQ(run(scene, 5e-3)->jet().y, without->jet().y) << solver;
  }
}

TEST(ExtremeCharge, so_small_that_its_square_underflows_is_harmless) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.nozzle->charge_density = 1e-160;
  for (const std::string solver : {"direct", "fmm"}) {
    scene.config.coulomb->solver = solver;
    expect_finite(run(scene, 2e-3)->jet());
  }
}

TEST(ExtremeScale, a_chain_beyond_any_length_runs_or_says_why_not) {
  for (const double far : {1e80, 1e150}) {
    for (const std::string solver : {"direct", "fmm"}) {
      Scene scene = chain_scene();
      for (int k = 0; k < 5; ++k)
        add_bead(scene, pvp_bead({k * far, 0.1 * far * (k % 2), 0}));
      scene.config.coulomb = CoulombConfig{.solver = solver};
      scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
      scene.config.surface_tension =
          SurfaceTensionConfig{.coefficient = pvp::surface_tension};
      auto simulation = build_simulation(scene);
      try {
        simulation->run_until(1e-3);
      } catch (const RunError& e) {
        expect_parts(e.what(), {"t = ", "bead "});
      }
      expect_finite(simulation->jet());
    }
  }
}

// A bead is a thousand times as heavy as the next one, here and at the nozzle.
TEST(ExtremeMass, ratio_of_a_thousand_keeps_the_closed_form_and_the_momentum) {
  const double r0 = 0.02 * cm, growth = 10;
  Scene scene = chain_scene();
  scene.config.coulomb = CoulombConfig{};
  add_bead(scene, pvp_bead({0, 0, 0}));
  Bead heavy = pvp_bead({0, r0, 0});
  heavy.mass *= 1e3;
  add_bead(scene, heavy);
  const double reduced = pvp::mass * 1e3 / 1001;
  const double time = std::sqrt(reduced * r0 * r0 * r0
                                / (2 * constants::coulomb * pvp::charge * pvp::charge))
                      * (std::sqrt(growth * (growth - 1)) + std::acosh(std::sqrt(growth)));
  const auto simulation = run(scene, time);
  const auto c = simulation->jet().columns();
  EXPECT_NEAR((c.position()[1] - c.position()[0]).norm() / (growth * r0), 1, 1e-10);
  EXPECT_NEAR(c.position().y[0] / (-(growth - 1) * r0 * 1e3 / 1001), 1, 1e-10);
  EXPECT_LE(std::abs(c.velocity().y[0] + 1e3 * c.velocity().y[1]),
            1e-14 * std::abs(c.velocity().y[0]));

  Scene jet = case_one("dormand-prince", 1e-7);
  jet.config.varicosity = VaricosityConfig{.every = 4, .factor = 1e3};
  jet.config.varicosity->volume = false;
  const FinishedRun varicose(jet, 2e-3, 1e-3);
  EXPECT_GT(varicose.simulation->statistics().insertions, 5U);
  EXPECT_LE(std::abs(varicose.last().at("energy_residual_relative")), 1e-7);
  EXPECT_LE(varicose.last().at("momentum_residual_relative"), 1e-7);
}

// At a million volts per metre a bead is born every ten microseconds, soon.
TEST(ExtremeField, inserts_several_beads_within_a_step) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.field = FieldConfig{.potential = {}, .strength = 1e6};
  const FinishedRun whole(scene, 2e-3, 1e-3);
  EXPECT_GT(whole.simulation->statistics().releases, 30U);
  EXPECT_LE(std::abs(whole.last().at("energy_residual_relative")), 1e-6);

  // With field and gravity only a step may be as long as one likes.
  scene.config.coulomb.reset(), scene.config.viscoelasticity.reset();
  scene.config.surface_tension.reset();
  integrate(scene, "dop853", 1e-10);
  const auto fine = run(scene, 4e-3);
  integrate_with_fixed_steps(scene, "rk4", 1e-3);
  const auto coarse = run(scene, 4e-3);
  EXPECT_GT(fine->statistics().insertions, 30U); // in four steps
  EXPECT_EQ(coarse->statistics().insertions, fine->statistics().insertions);
  EXPECT_EQ(coarse->statistics().releases, fine->statistics().releases);
  EXPECT_EQ(coarse->jet().time, 4e-3);
  for (std::size_t i = 0; i < fine->jet().y.size(); ++i)
    EXPECT_NEAR(coarse->jet().y[i], fine->jet().y[i],
                1e-4 * (1 + std::abs(fine->jet().y[i])));
}

// ---- refinement -----------------------------------------------------------------------------

/// A zig-zag of uncharged beads, `length` long, refined once.
Scene chain_to_refine(double link, double interval) {
  Scene scene = chain_scene();
  for (int k = 0; k <= 10; ++k)
    add_bead(scene, pvp_bead({k * 0.1, k % 2 * 0.01, 0}, {0, 1e-3 * k, 0}));
  integrate(scene, "dormand-prince", 1e-6);
  scene.config.refinement = RefinementConfig{.length = link, .interval = interval};
  return scene;
}

TEST(ExtremeRefinement, makes_more_than_a_hundred_thousand_beads_in_one_go) {
  Scene scene = chain_to_refine(5e-6, 1e-3);
  const auto simulation = run(scene, 1.5e-3);
  EXPECT_GT(simulation->jet().links(), 200'000U);
  EXPECT_EQ(simulation->statistics().refinements, 1U);
  expect_finite(simulation->jet());
  CompensatedSum mass;
  for (std::size_t k = 1; k < simulation->jet().beads(); ++k)
    mass += simulation->jet().mass[k];
  EXPECT_NEAR(mass / (10 * pvp::mass), 1, 1e-12);
}

TEST(ExtremeRefinement, that_no_memory_holds_is_refused_with_number_and_key) {
  for (const double link : {1e-9, 1e-300}) {
    const Scene scene = chain_to_refine(link, 1e-3);
    const std::string message = failure(scene, 2e-3);
    expect_parts(message, {"t = 0.001 s", "refinement.length", "links", "GB"});
  }
  Scene snapped = chain_to_refine(1e-9, 1e-3);
  snapped.config.integrator.events = EventPlacement::step_end;
  expect_parts(failure(snapped, 2e-3), {"t = ", "refinement.length"});
}

TEST(ExtremeRefinement, may_happen_several_times_a_step) {
  constexpr double rate = 500, interval = 4e-4, step = 2e-3;
  Scene scene = chain_scene();
  for (int k = 0; k <= 20; ++k)
    add_bead(scene, pvp_bead({k * 1e-3, 0, 0}, {rate * k * 1e-3, 0, 0}));
  integrate_with_fixed_steps(scene, "rk4", step);
  scene.config.refinement = RefinementConfig{.length = 1.1e-3, .interval = interval};
  scene.config.output.refinements = RefinementRecords::sums;
  RefinedRun often(scene);
  often.simulation->run_until(2 * step);
  ASSERT_GE(often.records.size(), 6U); // in two steps
  for (const RefinementRecord& r : often.records)
    EXPECT_EQ(r.time, std::round(r.time / interval) * interval);
  const JetState& jet = often.simulation->jet();
  for (std::size_t k = 1; k < jet.beads(); ++k) // l = l0 (1 + rate t), cut down to 1.1 mm
    EXPECT_LE(link_length(jet, k), 1.3 * 1.1e-3) << k;
  EXPECT_NEAR(jet.columns().position().x[jet.links()], 0.02 * (1 + rate * 2 * step), 1e-14);
}

// ---- degenerate places ----------------------------------------------------------------------

// Curvature zero, splines through points on a line, clusters without width.
TEST(StraightJet, is_refined_and_stays_straight_with_every_solver) {
  for (const std::string solver : {"direct", "treecode", "fmm", "auto"}) {
    Scene scene = refined_case(0.4 * cm);
    scene.config.nozzle->amplitude = 0;
    scene.config.coulomb->solver = solver;
    if (solver == "fmm" || solver == "treecode") scene.config.coulomb->leaf = 8;
    const auto simulation = run(scene, 9e-3);
    EXPECT_GE(simulation->statistics().refinements.value_or(0), 2U) << solver;
    const auto c = simulation->jet().columns();
    for (std::size_t k = 0; k < simulation->jet().beads(); ++k) {
      EXPECT_EQ(c.position()[k].tail<2>().norm(), 0) << solver << k;
      ASSERT_TRUE(std::isfinite(c.position().x[k])) << solver << k;
    }
  }
}

// A level chain falls flat on the collector: all its beads land at once, many in one place.
TEST(LandedBeads, in_one_place_are_no_trouble_to_any_solver) {
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    Scene scene = chain_scene();
    for (int k = 0; k < 200; ++k) {
      const double turn = k % 20 * 2 * std::numbers::pi / 20; // ten rounds of one ring
      add_bead(scene,
               pvp_bead({0.05 + 1e-4 * k, 1e-3 * std::cos(turn), 1e-3 * std::sin(turn)},
                        {10, 0, 0}));
    }
    // They fly side by side and uncharged, so that they meet on the plane.
    for (double& q : scene.chain.charge) q *= 1e-6;
    scene.config.coulomb = CoulombConfig{.solver = solver, .leaf = {}};
    if (solver != "direct") scene.config.coulomb->leaf = 8;
    scene.config.collector = CollectorConfig{0.1};
    integrate(scene, "dormand-prince", 1e-6);
    scene.config.integrator.landings = LandingSteps::located;
    const auto simulation = run(scene, 6e-3);
    EXPECT_GT(simulation->statistics().landings, 190U) << solver;
    expect_finite(simulation->jet());
  }
}

// ---- threads and restarts -------------------------------------------------------------------

TEST(Threads, change_a_step_by_round_off_only) {
  Scene scene = chain_scene();
  for (int k = 0; k < 1500; ++k)
    add_bead(scene,
             pvp_bead({k * 2e-4, 1e-4 * std::sin(0.3 * k), 1e-4 * std::cos(0.3 * k)}));
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  scene.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension};
  const int threads = omp_get_max_threads();
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    scene.config.coulomb = CoulombConfig{.solver = solver};
    integrate_with_fixed_steps(scene, "rk4", 1e-6);
    omp_set_num_threads(1);
    const auto one = run(scene, 1e-6), again = run(scene, 1e-6);
    omp_set_num_threads(2);
    const auto two = run(scene, 1e-6);
    EXPECT_EQ(one->jet().y, again->jet().y) << solver;
    const std::size_t n = one->jet().beads();
    for (std::size_t column = 0; column < 7; ++column) {
      double difference = 0, size = 0;
      for (std::size_t i = column * n; i < (column + 1) * n; ++i) {
        difference = std::max(difference, std::abs(one->jet().y[i] - two->jet().y[i]));
        size = std::max(size, std::abs(one->jet().y[i]));
      }
      EXPECT_LE(difference, 1e-13 * size) << solver << column;
    }
  }
  omp_set_num_threads(threads);
}

// What is left of twenty million steps.
TEST(Time, does_not_drift_over_twenty_million_steps) {
  CompensatedSum time;
  const double dt = 1e-8;
  for (int n = 0; n < 20'000'000; ++n) time += dt;
  EXPECT_EQ(double(time), 20'000'000 * dt);
}

} // namespace
} // namespace ehdjet
