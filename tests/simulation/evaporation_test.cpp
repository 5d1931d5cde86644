#include "ehdjet/forces/evaporation.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "support/budgeted.hpp"
#include "support/rheologies.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// The PVP jet in air that takes up its solvent, ten times faster than ethanol so that short runs see it.
Scene drying_jet(const std::string& method, double rtol) {
  Scene scene = case_one(method, rtol);
  scene.config.air = AirConfig{};
  scene.config.evaporation = EvaporationConfig{.solvent_density = 789,
                                               .polymer_density = 1200,
                                               .polymer_fraction = 0.1,
                                               .diffusivity = 1.18e-5,
                                               .saturation = 1.11};
  return scene;
}

std::span<const double> evaporated(const JetState& jet) {
  return jet.columns().column(*jet.table->find_integrated(Evaporation::column));
}

TEST(DryingJet, loses_solvent_on_its_way_and_never_more_than_it_has) {
  const Scene scene = drying_jet("dormand-prince", 1e-6);
  const JetState jet = run(scene, 12e-3)->jet();
  const Solution solution = scene.config.evaporation->solution();
  const auto lost = evaporated(jet);
  for (std::size_t k = jet.first() + 1; k < jet.beads(); ++k) {
    EXPECT_GE(lost[k], lost[k - 1] - 1e-3) << k; // who is older is drier
    EXPECT_LE(lost[k], solution.lost_at(0.9) + 1e-6) << k;
    EXPECT_GE(link_volume(jet, k), solution.polymer_volume() * jet.volume[k]);
    EXPECT_GT(link_mass(jet, k), 0.1 * jet.mass[k]); // the polymer stays
  }
  EXPECT_EQ(lost[0], 0);
  EXPECT_GT(lost.back(), 0.3);
}

// m dv/dt = F with the mass that is left: vapour takes its momentum along.
TEST(DryingJet, falls_as_fast_as_a_wet_one_under_gravity_alone) {
  Scene scene = drying_jet("dormand-prince", 1e-9);
  scene.config.nozzle.reset(), scene.config.collector.reset();
  scene.config.field.reset(), scene.config.coulomb.reset();
  scene.config.viscoelasticity.reset(), scene.config.surface_tension.reset();
  scene.config.chain = ChainConfig{.file = "", .time = {}};
  for (int k = 0; k < 3; ++k) add_bead(scene, pvp_bead({0.02 * k * cm, 0, 0}));
  scene.config.air->density = 1e-12; // no drag
  const JetState jet = run(scene, 1e-2)->jet();
  EXPECT_GT(evaporated(jet)[2], 0.01);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(jet.columns().velocity().x[k] / (pvp::gravity * 1e-2), 1, 1e-8);
}

TEST(DryingJet, converges_whatever_the_method) {
  const JetState exact = run(drying_jet("dop853", 1e-11), 4e-3)->jet();
  for (const std::string method : {"dormand-prince", "ros34pw2", "two-rate"}) {
    const auto error = [&](double rtol) {
      const JetState jet = run(drying_jet(method, rtol), 4e-3)->jet();
      double difference = largest_distance(jet, exact);
      for (std::size_t k = 0; k < std::min(jet.beads(), exact.beads()); ++k)
        difference = std::max(difference,
                              1e-2 * std::abs(evaporated(jet)[k] - evaporated(exact)[k]));
      return difference;
    };
    const double at_5 = error(1e-5), at_7 = error(1e-7);
    EXPECT_LE(at_5, 3e-5) << method;
    EXPECT_LE(at_7, 0.05 * at_5) << method;
  }
}

// Masses that change from stage to stage must not spoil an implicit method.
TEST(DryingJet, converges_with_the_order_of_the_method) {
  const auto jet_after = [](const std::string& method, double step) {
    Scene scene = drying_jet("dop853", 1e-13);
    scene.config.evaporation->saturation *= 20;   // a few per cent of the mass per step
    scene.config.air->drag = DragLaw::tangential; // smooth
    if (step > 0) integrate_with_fixed_steps(scene, method, step);
    return run(scene, 5e-4)->jet();
  };
  const JetState exact = jet_after("dop853", 0);
  for (const auto& [method, longest, expected] :
       {std::tuple{"rk4", 2e-6, 4.0}, {"ros34pw2", 1e-6, 3.0}}) {
    std::vector<double> steps, errors;
    for (int i = 0; i < 8; ++i) {
      steps.push_back(longest * std::pow(2, -i / 2.0));
      errors.push_back(largest_distance(jet_after(method, steps.back()), exact));
    }
    EXPECT_NEAR(observed_order(steps, errors), expected, 0.3) << method;
  }
}

TEST(DryingJet, of_every_fluid_that_thickens_runs_whatever_the_method) {
  for (const NamedRheology& r : rheologies_of_pvp()) {
    if (r.fluid.model == Rheology::kelvin_voigt
        || r.fluid.model == Rheology::herschel_bulkley)
      continue;
    JetState jets[2];
    for (const bool implicit : {false, true}) {
      Scene scene = drying_jet(implicit ? "ros34pw2" : "dormand-prince", 1e-7);
      scene.config.viscoelasticity = r.fluid;
      jets[implicit ? 1 : 0] = run(scene, 1e-3)->jet();
    }
    EXPECT_LE(largest_distance(jets[0], jets[1]), 1e-6) << r.name;
  }
}

// The thinnest links are dry within nanoseconds and stay so. Implicit steps must not follow.
TEST(DryingJet, that_is_dry_and_thin_takes_long_implicit_steps) {
  std::uint64_t evaluations[2];
  for (const bool thin : {false, true}) {
    Scene scene = drying_jet("ros34pw2", 1e-5);
    scene.config.nozzle.reset(), scene.config.collector.reset();
    scene.config.field.reset(), scene.config.coulomb.reset();
    scene.config.viscoelasticity.reset(), scene.config.surface_tension.reset();
    scene.config.chain = ChainConfig{.file = "", .time = {}};
    const double scale = thin ? 1e-4 : 1;
    for (int k = 0; k < 3; ++k) {
      Bead bead = pvp_bead({0.2 * k * cm, 0, 0});
      bead.volume *= scale, bead.mass *= scale, bead.charge *= scale;
      add_bead(scene, bead);
    }
    scene.config.air->density = 1e-12; // no drag
    const auto simulation = run(scene, 1e-2);
    evaluations[thin ? 1 : 0] = simulation->dynamics().evaluations();
    if (thin) {
      const double end = scene.config.evaporation->solution().lost_at(0.9);
      EXPECT_NEAR(evaporated(simulation->jet())[2], end, 1e-4);
    }
  }
  EXPECT_LT(evaluations[1], 20 * evaluations[0]);
}

TEST(DryingJet, is_the_same_after_a_checkpoint) {
  Scene scene = drying_jet("two-rate", 1e-5);
  auto whole = build_simulation(scene), first = build_simulation(scene);
  struct Last final : Observer {
    void checkpoint(const Checkpoint& c) override { kept = c; }
    Checkpoint kept;
  };
  const auto last = std::make_shared<Last>();
  for (auto* s : {whole.get(), first.get()}) s->make_checkpoints(4e-3);
  whole->run_until(10e-3);
  first->add(last);
  first->run_until(9e-3);
  auto second = build_simulation(scene);
  second->make_checkpoints(4e-3);
  second->restore(last->kept);
  second->run_until(10e-3);
  EXPECT_EQ(second->jet().y, whole->jet().y);
}

// The solvent of a jet is V_0 (1 - e) less the polymer; it is moved, but neither lost nor less than none.
TEST(DryingJet, keeps_its_solvent_through_a_thousand_remaps) {
  for (const RefinedMesh mesh : {RefinedMesh::redistribute, RefinedMesh::cut}) {
    Scene scene = drying_jet("dormand-prince", 1e-5);
    scene.config.refinement = RefinementConfig{.length = 0.2 * cm, .interval = 1e-3};
    JetState jet = run(scene, 9e-3)->jet();
    const auto solvent = [&](const JetState& j) {
      double sum = 0;
      for (std::size_t k = 1; k < j.beads(); ++k) sum += link_volume(j, k);
      return sum;
    };
    const double before = solvent(jet);
    const double end = scene.config.evaporation->solution().lost_at(0.9);
    for (int i = 0; i < 1000; ++i) {
      // Links of other lengths each time, some of them joined again.
      RefinementRule rule;
      rule.length = (0.05 + 0.02 * (i % 7)) * cm;
      rule.coarsen = (0.04 + 0.02 * (i % 3)) * cm;
      rule.has_nozzle = true;
      if (mesh == RefinedMesh::cut)
        (void)cut_links(jet, rule);
      else
        (void)refine_jet(jet, rule);
      (void)coarsen_jet(jet, rule);
      const auto lost = evaporated(jet);
      const auto [least, most] = std::ranges::minmax(lost.subspan(1));
      ASSERT_GE(least, -1e-15) << i;
      ASSERT_LE(most, end + 1e-9) << i;
    }
    EXPECT_NEAR(solvent(jet) / before, 1, 1e-12);
  }
}

TEST(DryingJet, that_is_pumped_brings_fresh_fluid) {
  Scene scene = drying_jet("dormand-prince", 1e-6);
  NozzleConfig& n = *scene.config.nozzle;
  n.inflow = InflowKind::pump, n.velocity.reset();
  n.flow_rate = 65e-6 / 3600, n.link_length = 6 * n.radius;
  scene.config.surface_tension->form = SurfaceTensionForm::line;
  const JetState jet = run(scene, 5e-3)->jet();
  const auto lost = evaporated(jet);
  EXPECT_GT(lost[1], 0);
  EXPECT_LT(lost[1], lost[3]);
  double wet = 0;
  for (std::size_t k = 1; k < jet.beads(); ++k) wet += jet.volume[k];
  EXPECT_NEAR(wet / (*n.flow_rate * 5e-3 + n.section() * n.link_length / 2), 1, 1e-12);
}

double residual(const FinishedRun& run) {
  return std::max(std::abs(run.last().at("energy_residual_relative")),
                  std::abs(run.last().at("momentum_residual_relative")));
}

// Volume, modulus and relaxation time change with the solvent, and with them what a link stores.
TEST(DryingJet, has_a_budget_that_closes_with_the_tolerance_for_each_law) {
  for (const NamedRheology& r : rheologies_of_pvp()) {
    if (r.name == "kelvin_voigt" || r.name == "herschel_bulkley") continue;
    for (const double rtol : {1e-5, 1e-7}) {
      Scene scene = drying_jet("dormand-prince", rtol);
      scene.config.viscoelasticity = r.fluid;
      scene.config.surface_tension->form = SurfaceTensionForm::line;
      scene.config.coulomb->near_field = NearFieldForm::free_surface;
      scene.config.gravity = GravityConfig{.acceleration = 9.80665};
      const FinishedRun run(scene, 3e-3, 1e-3);
      EXPECT_LE(residual(run), rtol) << r.name << ' ' << rtol;
      EXPECT_GT(std::abs(run.last().at("evaporation_exchange")),
                1e-4 * run.last().at("kinetic_energy"));
      EXPECT_NE(run.last().at("vapour_impulse_x"), 0);
    }
  }
}

TEST(DryingJet, has_a_budget_that_closes_whatever_happens_to_it) {
  Scene refined = drying_jet("dormand-prince", 1e-6), pumped = refined,
        implicit = drying_jet("ros34pw2", 1e-7), two_rates = drying_jet("two-rate", 1e-7);
  refined.config.refinement = RefinementConfig{.length = 0.4 * cm, .interval = 1e-3};
  NozzleConfig& n = *pumped.config.nozzle;
  n.inflow = InflowKind::pump, n.velocity.reset();
  n.flow_rate = 65e-6 / 3600, n.link_length = 6 * n.radius;
  pumped.config.surface_tension->form = SurfaceTensionForm::line;
  for (const auto& [what, scene, end] : {std::tuple{"refined", refined, 12e-3},
                                         {"pumped", pumped, 5e-3},
                                         {"implicit", implicit, 4e-3},
                                         {"two rates", two_rates, 6e-3}}) {
    const FinishedRun run(scene, end, 1e-3);
    EXPECT_LE(residual(run), 1e-6) << what;
    EXPECT_NE(run.last().at("evaporation_exchange"), 0) << what;
  }
}

} // namespace
} // namespace ehdjet
