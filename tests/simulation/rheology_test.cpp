#include "ehdjet/refinement/refine_jet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "support/allocations.hpp"
#include "support/budgeted.hpp"
#include "support/pumped.hpp"
#include "support/refined.hpp"
#include "support/rheologies.hpp"

namespace ehdjet {
namespace {

using namespace test;

// ---- Kelvin-Voigt -----------------------------------------------------------------------------

// Computed independently: a bead on one link of the PVP jet, 1.2 times as long as at rest.
TEST(KelvinVoigt, a_bead_on_a_link_swings_as_in_the_table) {
  struct Row {
    double viscosity, x[4];
  };
  const double times[] = {1e-5, 5e-5, 1e-4, 5e-4};
  const Row rows[] = {
      {0, {2.3977386524e-4, 2.3444312683e-4, 2.1901508064e-4, 2.3917431151e-4}},
      {2, {2.3980208440e-4, 2.3690202904e-4, 2.3222660814e-4, 2.1060218639e-4}}};
  for (const auto& row : rows) {
    Scene scene = chain_scene(FixedEnds::first);
    for (const double x : {0., 1.2})
      add_bead(scene, pvp_bead({x * pvp::link_length, 0, 0}));
    scene.chain.others["reference_length_m"].values = {0, pvp::link_length};
    scene.config.viscoelasticity = ViscoelasticityConfig{.elastic_modulus = 5e3,
                                                         .viscosity = row.viscosity,
                                                         .model = Rheology::kelvin_voigt};
    integrate(scene, "dop853", 1e-13);
    auto simulation = build_simulation(scene);
    for (std::size_t i = 0; i < 4; ++i) {
      simulation->run_until(times[i]);
      EXPECT_NEAR(simulation->jet().columns().position().x[1] / row.x[i], 1, 1e-10)
          << row.viscosity << " " << times[i];
    }
  }
}

TEST(KelvinVoigt, a_chain_without_reference_lengths_starts_without_stress) {
  Scene scene = chain_scene(FixedEnds::first);
  for (const double x : {0., 1., 3.}) add_bead(scene, pvp_bead({x * 1e-4, 0, 0}));
  scene.config.viscoelasticity = ViscoelasticityConfig{
      .elastic_modulus = 5e3, .viscosity = 1, .model = Rheology::kelvin_voigt};
  const JetState start = initial_jet(scene);
  EXPECT_NEAR(start.declared.at(0)[1], 1e-4, 1e-18);
  EXPECT_NEAR(start.declared.at(0)[2], 2e-4, 1e-18);
  EXPECT_NEAR(run(scene, 1e-3)->jet().columns().position().x[2], 3e-4, 1e-15);
  scene.chain.others["reference_length_m"].values = {0, 1e-4, 0};
  EXPECT_THROW(initial_jet(scene), InputError);
}

// sigma = G ln(A0/A): the reference length is that of the fluid at the section of the nozzle.
TEST(KelvinVoigt, reference_lengths_are_volumes_over_the_section_of_the_nozzle) {
  Scene pumped = jet_k(0.02 * cm, 0.05 * cm), born = refined_case(0.05 * cm);
  for (Scene* scene : {&pumped, &born}) {
    scene->config.viscoelasticity = ViscoelasticityConfig{
        .elastic_modulus = 2e3, .viscosity = 0.5, .model = Rheology::kelvin_voigt};
    const auto simulation = run(*scene, 6e-3);
    EXPECT_GT(*simulation->statistics().refinements, 0U);
    const JetState& jet = simulation->jet();
    ASSERT_GT(jet.beads(), 40U);
    double worst = 0;
    for (std::size_t k = 2; k < jet.beads(); ++k)
      worst = std::max(worst, std::abs(jet.declared[0][k] * scene->config.nozzle->section()
                                           / jet.volume[k]
                                       - 1));
    EXPECT_LE(worst, 1e-12);
  }
}

// ---- every law --------------------------------------------------------------------------------

class EachRheology : public testing::TestWithParam<NamedRheology> {
protected:
  [[nodiscard]] Scene with_fluid(Scene scene) const {
    scene.config.viscoelasticity = GetParam().fluid;
    return scene;
  }
  /// Without a nozzle's fluid: a golden chain that is strained and that has stress.
  [[nodiscard]] Scene chain(const std::string& kind) const {
    Scene scene = with_fluid(GoldenChain(kind).scene);
    const auto stress = stresses(scene.chain);
    for (const char* column : {"tau_zz_pa", "tau_rr_pa"})
      for (const double s : stress)
        scene.chain.others[column].values.push_back(column[4] == 'z' ? s : -0.2 * s);
    return scene;
  }
};
INSTANTIATE_TEST_SUITE_P(All, EachRheology, testing::ValuesIn(rheologies_of_pvp()),
                         [](const auto& rheology) { return rheology.param.name; });

TEST_P(EachRheology, has_a_budget_of_a_chain_that_closes_to_round_off) {
  for (const std::string kind : {"free", "held"}) {
    Scene scene = chain(kind);
    integrate(scene, "dop853", 1e-12);
    const FinishedRun run(scene, 2e-4, 2e-4 / 7);
    EXPECT_LE(run.worst(), 1e-12 * run.rows.front().at("coulomb_energy")) << kind;
    EXPECT_GT(run.last().at("dissipated_energy"), 0);
    EXPECT_NE(run.last().at("elastic_energy"), run.rows.front().at("elastic_energy"));
    EXPECT_LE(run.last().at("momentum_residual_relative"), 1e-14) << kind;
  }
}

TEST_P(EachRheology, has_a_budget_of_a_jet_that_closes_with_the_tolerance) {
  for (const double rtol : {1e-5, 1e-7}) {
    const FinishedRun run(with_fluid(case_one("dormand-prince", rtol)), 3e-3, 1e-3);
    EXPECT_GT(run.simulation->statistics().insertions, 20U);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 0.3 * rtol) << rtol;
    EXPECT_LE(run.last().at("momentum_residual_relative"), rtol) << rtol;
    RecordProperty("residual",
                   std::to_string(run.last().at("energy_residual_relative") * 1e9));
  }
}

TEST_P(EachRheology, has_a_budget_of_a_jet_that_lands_and_is_refined) {
  const FinishedRun run(with_fluid(refined_case(0.4 * cm, 1e-3, 1e-6)), 12e-3, 1e-3);
  EXPECT_GT(run.simulation->statistics().landings, 5U);
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 2e-7);
}

TEST_P(EachRheology, has_a_budget_of_a_pumped_jet_that_closes) {
  Scene scene = with_fluid(jet_k(0.02 * cm, 0.4 * cm, 1e-6));
  scene.config.coulomb->near_field = NearFieldForm::free_surface;
  scene.config.refinement.reset();
  scene.config.nozzle->nozzle_stress = 50;
  scene.config.nozzle->flow_rate = 40 * mL_h;
  const FinishedRun run(scene, 3e-3, 1e-3);
  // The flow curve has a kink where a strain rate passes zero.
  const double bound = GetParam().name == "herschel_bulkley" ? 1e-6 : 1e-7;
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), bound);
  EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 1e-6);
}

TEST_P(EachRheology, is_integrated_by_ros34pw2_with_third_order) {
  Scene scene = chain("held");
  if (GetParam().name == "herschel_bulkley") { // smooth as long as no strain rate is zero
    constexpr double strain_rate = 1e4;
    scene.config.viscoelasticity->consistency = 1;
    std::ranges::fill(stresses(scene.chain), 0.0);
    for (std::size_t k = 0; k < scene.chain.size(); ++k) {
      scene.chain.x[k] = static_cast<double>(k) * pvp::link_length;
      scene.chain.vx[k] = strain_rate * scene.chain.x[k];
      for (auto* zero : {&scene.chain.y, &scene.chain.z, &scene.chain.vy, &scene.chain.vz})
        (*zero)[k] = 0;
    }
  }
  const auto end = [&](const std::string& method, double step) {
    integrate_with_fixed_steps(scene, method, step);
    return run(scene, 1e-4)->jet();
  };
  const JetState exact = end("dop853", 2.5e-7);
  std::vector<double> steps, errors;
  for (const double step : {2.5e-6, 1.25e-6, 6.25e-7, 3.125e-7}) {
    const JetState jet = end("ros34pw2", step);
    double squares = 0;
    for (std::size_t k = 0; k < jet.beads(); ++k)
      squares +=
          (jet.columns().position()[k] - exact.columns().position()[k]).squaredNorm();
    steps.push_back(step), errors.push_back(std::sqrt(squares));
  }
  EXPECT_NEAR(observed_order(steps, errors), 3, 0.15);
}

TEST_P(EachRheology, allocates_nothing_while_the_chain_keeps_its_beads) {
  for (const char* method : {"dormand-prince", "ros34pw2", "auto"}) {
    Scene scene = chain("held");
    integrate(scene, method, 1e-8);
    auto simulation = build_simulation(scene);
    simulation->run_until(2e-5);
    const std::size_t before = allocations();
    simulation->run_until(1e-4);
    EXPECT_EQ(allocations() - before, 0U) << method;
  }
}

/// The largest distance of a bead of one jet from that of the other [m].
double distance(const JetState& a, const JetState& b) {
  double largest = 0;
  EXPECT_EQ(a.beads(), b.beads());
  for (std::size_t k = 0; k < std::min(a.beads(), b.beads()); ++k)
    largest =
        std::max(largest, (a.columns().position()[k] - b.columns().position()[k]).norm());
  return largest;
}

TEST_P(EachRheology, is_the_same_with_all_methods) {
  const double end = 6e-3;
  const auto simulate = [&](const std::string& method, double rtol) {
    return run(with_fluid(case_one(method, rtol)), end);
  };
  const JetState exact = simulate("dormand-prince", 1e-9)->jet();
  for (const std::string method : {"dormand-prince", "ros34pw2", "auto", "two-rate"}) {
    const auto simulation = simulate(method, 1e-6);
    EXPECT_LE(distance(simulation->jet(), exact), 5e-5 * cm) << method;
    if (method == "two-rate") {
      EXPECT_GT(simulation->statistics().two_rates->steps, 2U);
    }
  }
}

// Newtonian fluids, or a dashpot that explicit steps would have to follow.
TEST_P(EachRheology, is_stiff_and_left_to_implicit_steps) {
  ViscoelasticityConfig fluid = GetParam().fluid;
  constexpr double stiffer = 1e5;
  if (fluid.modes) {
    for (RelaxationMode& m : *fluid.modes)
      m.modulus *= stiffer, m.relaxation_time /= stiffer;
  } else if (fluid.model == Rheology::kelvin_voigt) {
    fluid.viscosity = 20;
  } else {
    *fluid.elastic_modulus *= stiffer;
  }
  Scene scene = case_one("auto", 1e-5);
  scene.config.viscoelasticity = fluid;
  const FinishedRun run(scene, 2e-3, 1e-3);
  EXPECT_EQ(run.simulation->statistics().method->in_use, "ros34pw2");
  EXPECT_LE(run.simulation->statistics().steps, 3000U);
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-4);
}

TEST_P(EachRheology, goes_on_from_two_rates_refined_and_pumped) {
  Scene scene = with_fluid(jet_k(0.02 * cm, 0.4 * cm));
  scene.config.integrator.method = "two-rate";
  const auto simulation = run(scene, 6e-3);
  EXPECT_GT(simulation->statistics().two_rates->steps, 5U);
  EXPECT_TRUE(std::ranges::all_of(simulation->jet().y,
                                  [](double value) { return std::isfinite(value); }));
}

// Sums of volume times stress, or conformation, and of reference lengths.
TEST_P(EachRheology, keeps_its_sums_on_another_mesh) {
  if (GetParam().name == "maxwell" || GetParam().name == "herschel_bulkley")
    return; // a spline, unless the scene says otherwise
  Scene scene = with_fluid(refined_case(0.05 * cm));
  for (const RefinedMesh mesh : {RefinedMesh::redistribute, RefinedMesh::cut}) {
    JetState jet = run(with_fluid(case_one()), 3e-3)->jet();
    jet.table = initial_jet(scene).table;
    const auto sums = [&] {
      std::vector<double> all;
      const auto integrated = jet.table->integrated();
      for (std::size_t c = BeadTable::basic_integrated; c < integrated.size(); ++c) {
        EXPECT_EQ(integrated[c].remap, ColumnRemap::conservative);
        double sum = 0;
        for (std::size_t k = 1; k < jet.beads(); ++k)
          sum += jet.volume[k] * jet.columns().column(c)[k];
        all.push_back(sum);
      }
      for (const auto& column : jet.declared) {
        double sum = 0;
        for (std::size_t k = 1; k < jet.beads(); ++k) sum += column[k];
        all.push_back(sum);
      }
      return all;
    };
    const std::size_t before = jet.beads();
    const auto expected = sums();
    ASSERT_FALSE(expected.empty());
    const RefinementRule rule{
        .length = 0.05 * cm, .coarsen = {}, .shortest = {}, .collector = {}};
    ASSERT_TRUE(mesh == RefinedMesh::cut ? cut_links(jet, rule) : refine_jet(jet, rule));
    EXPECT_GT(jet.beads(), before);
    const auto got = sums();
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(got[i] / expected[i], 1, 1e-12) << i;
  }
}

TEST_P(EachRheology, is_scaled_and_remapped_as_the_scene_says) {
  Scene scene = with_fluid(refined_case(0.4 * cm));
  if (GetParam().name == "kelvin_voigt") {
    EXPECT_EQ(initial_jet(scene).columns().count(), BeadTable::basic_integrated);
    return;
  }
  scene.config.integrator.stress_scale = 7;
  scene.config.refinement->stress = ColumnRemap::spline;
  const JetState jet = initial_jet(scene);
  const auto integrated = jet.table->integrated().subspan(BeadTable::basic_integrated);
  EXPECT_GE(integrated.size(), 1U);
  for (const BeadColumn& column : integrated) {
    EXPECT_EQ(column.error_scale * column.stress_of_one, 7) << column.name;
    EXPECT_EQ(column.remap, ColumnRemap::spline) << column.name;
  }
}

TEST(Rheology, of_a_chain_is_at_rest_or_as_its_file_says) {
  Scene scene = chain_scene();
  for (const double x : {0., 1., 3.}) add_bead(scene, pvp_bead({x * 1e-4, 0, 0}));
  scene.config.viscoelasticity = ViscoelasticityConfig{.elastic_modulus = 5e3,
                                                       .viscosity = 1,
                                                       .model = Rheology::fene_p,
                                                       .extensibility = 9.0};
  scene.chain.others["conformation_zz"].values = {0, 2, 3};
  const JetState jet = initial_jet(scene);
  const auto zz = jet.columns().column(BeadTable::basic_integrated),
             rr = jet.columns().column(BeadTable::basic_integrated + 1);
  EXPECT_EQ(std::vector<double>(zz.begin(), zz.end()), (std::vector<double>{0, 2, 3}));
  EXPECT_EQ(std::vector<double>(rr.begin(), rr.end()), (std::vector<double>{1, 1, 1}));
}

// What is born at a nozzle has no stress; a pump's fluid has what it is given.
TEST(Rheology, of_a_pump_starts_with_the_stress_of_the_nozzle) {
  for (const auto& [name, fluid] : rheologies_of_pvp()) {
    Scene scene = straight_pumped(20 * mL_h, 20 * poise, 0.02 * cm);
    scene.config.viscoelasticity = fluid;
    scene.config.nozzle->nozzle_stress = 120;
    scene.config.viscoelasticity->solvent_viscosity =
        fluid.solvent_viscosity ? std::optional(1e-12) : std::nullopt;
    if (fluid.model == Rheology::kelvin_voigt) scene.config.viscoelasticity->viscosity = 0;
    const auto dynamics = build_dynamics(scene);
    JetState jet = initial_jet(scene);
    ActingChain chain;
    chain.constrain(dynamics->constraints());
    dynamics->bind(jet), chain.bind(jet);
    std::vector<double> tension(jet.beads(), 0.0);
    for (const auto& term : dynamics->terms())
      if (term->name() != "surface tension (line)")
        term->add_tension(chain.at(0, jet.y), tension);
    EXPECT_NEAR(tension[1] / scene.config.nozzle->section(), 120, 1e-9 * 120) << name;
  }
}

// Oldroyd-B without solvent, Giesekus without mobility.
TEST(Rheology, of_one_kind_have_the_same_bits_where_they_are_the_same) {
  const auto end = [](Rheology model) {
    Scene scene = case_one();
    scene.config.viscoelasticity =
        ViscoelasticityConfig{.elastic_modulus = 5e3, .viscosity = 2, .model = model};
    if (model == Rheology::oldroyd_b) scene.config.viscoelasticity->solvent_viscosity = 0;
    if (model == Rheology::giesekus) scene.config.viscoelasticity->mobility = 0;
    return run(scene, 2e-3)->jet().y;
  };
  const auto expected = end(Rheology::upper_convected_maxwell);
  EXPECT_EQ(end(Rheology::oldroyd_b), expected);
  EXPECT_EQ(end(Rheology::giesekus), expected);
}

// The scalar law lets a jet stretch too easily.
TEST(Rheology, a_tensor_holds_a_jet_back) {
  const auto path = [](Rheology model) {
    Scene scene = case_one();
    scene.config.viscoelasticity->model = model;
    const JetState jet = run(scene, 6e-3)->jet();
    return jet.columns().position().x[jet.links()];
  };
  EXPECT_LT(path(Rheology::upper_convected_maxwell), 0.97 * path(Rheology::maxwell));
}

} // namespace
} // namespace ehdjet
