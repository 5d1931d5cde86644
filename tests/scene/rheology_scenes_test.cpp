#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/scene/schema.hpp"
#include "ehdjet/scene/stability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "support.hpp"

namespace ehdjet {
namespace {

const std::string fluid = "elastic_modulus = 5e3\nviscosity = 2\n";
/// The good scene with another [viscoelasticity].
std::string with(const std::string& keys) {
  return good_scene_but(fluid, keys);
}
std::string model(const std::string& name, const std::string& keys = fluid) {
  return with("model = \"" + name + "\"\n" + keys);
}
const std::string curve = fluid + "consistency = 20\nflow_index = 0.5\n";

struct Good {
  const char* name;
  std::string keys;
};
const Good good_models[] = {
    {"maxwell", fluid},
    {"upper-convected-maxwell", fluid},
    {"upper-convected-maxwell", "modes = [[5e3, 4e-4], [1, 2]]\n"},
    {"oldroyd-b", fluid + "solvent_viscosity = 0\n"},
    {"giesekus", fluid + "mobility = 0.1\n"},
    {"giesekus", "modes = [[5e3, 4e-4]]\nmobility = 0\nsolvent_viscosity = 0.1\n"},
    {"fene-p", fluid + "extensibility = 100\n"},
    {"kelvin-voigt", fluid},
    {"kelvin-voigt", "elastic_modulus = 0\nviscosity = 1\n"},
    {"herschel-bulkley", curve},
    {"herschel-bulkley", curve + "yield_stress = 100\nregularization = 0.01\n"},
};

TEST(RheologyScenes, are_accepted_and_read_back_from_what_a_run_file_has) {
  for (const auto& [name, keys] : good_models) {
    EXPECT_EQ(complaint_about(model(name, keys)), "(accepted)") << name;
    const SceneConfig config = read(model(name, keys)).config;
    EXPECT_EQ(name_of(config.viscoelasticity->model, rheologies), name);
    EXPECT_EQ(read(resolved_toml(config)).config, config) << name;
    expect_all(scene_report(read(model(name, keys))),
               {name == std::string("maxwell") ? "(Maxwell)" : name});
  }
}

TEST(RheologyScenes, have_the_maxwell_fluid_by_default) {
  const ViscoelasticityConfig c = *read(good_scene).config.viscoelasticity;
  EXPECT_EQ(c.model, Rheology::maxwell);
  EXPECT_EQ(c.elastic_modulus, 5e3);
  EXPECT_EQ(c.viscosity, 2);
  EXPECT_FALSE(c.modes || c.mobility || c.solvent_viscosity || c.extensibility);
}

TEST(RheologyScenes, with_modes_have_their_numbers) {
  const SceneConfig config =
      read(model("fene-p", "modes = [[5e3, 4e-4], [1000, 2]]\nextensibility = 50\n"))
          .config;
  EXPECT_EQ(config.viscoelasticity->relaxation_modes(),
            (std::vector<RelaxationMode>{{5e3, 4e-4}, {1000, 2}}));
  const auto groups = dimensionless_groups(config);
  EXPECT_NEAR(groups->time, (2 + 2000) / 6e3, 1e-12);
  const std::string other = resolved_toml(config);
  SceneConfig changed = config;
  changed.viscoelasticity->modes->back().modulus = 999;
  expect_all(difference_from(other, changed).value(),
             {"viscoelasticity.modes was [[5000, 0.0004], [1000, 2]]",
              "now it is [[5000, 0.0004], [999, 2]]"});
}

struct Wrong {
  const char* name;
  std::string text;
  std::vector<std::string> expected;
};
std::ostream& operator<<(std::ostream& os, const Wrong& w) {
  return os << w.name;
}

const Wrong wrong_models[] = {
    {"unknown_model",
     model("burgers"),
     {"s.toml:18: viscoelasticity.model = \"burgers\": must be \"maxwell\"",
      "\"oldroyd-b\", \"giesekus\", \"fene-p\", \"kelvin-voigt\" or \"herschel-bulkley\""}},
    {"no_modulus",
     with("viscosity = 2\n"),
     {"s.toml:17: viscoelasticity.elastic_modulus is missing: must be from 0 to 1e+12 Pa",
      "G"}},
    {"no_viscosity",
     with("elastic_modulus = 5e3\n"),
     {"s.toml:17: viscoelasticity.viscosity is missing: must be from 0 to 1e+06 Pa s"}},
    {"modes_of_a_scalar",
     with("modes = [[5e3, 4e-4]]\n"),
     {"s.toml:18: viscoelasticity.modes = [[5000, 0.0004]] has no meaning with "
      "viscoelasticity.model = \"maxwell\"",
      "\"giesekus\""}},
    {"modes_and_a_modulus",
     model("upper-convected-maxwell", "modes = [[5e3, 4e-4]]\nelastic_modulus = 5e3\n"),
     {"s.toml:20: viscoelasticity.elastic_modulus = 5000 Pa and viscoelasticity.modes = "
      "[[5000, 0.0004]]",
      "Remove one"}},
    {"modes_and_a_viscosity",
     model("upper-convected-maxwell", "modes = [[5e3, 4e-4]]\nviscosity = 2\n"),
     {"viscoelasticity.viscosity = 2 Pa s and viscoelasticity.modes"}},
    {"a_mode_that_is_a_number",
     model("upper-convected-maxwell", "modes = [5e3, 4e-4]\n"),
     {"s.toml:19: viscoelasticity.modes = [5000, 0.0004]: must be 1 to 16 pairs [G, "
      "lambda]",
      "1e+12 Pa", "1e+06 s"}},
    {"a_mode_out_of_range",
     model("upper-convected-maxwell", "modes = [[5e3, 4e-4], [1e3, 0]]\n"),
     {"viscoelasticity.modes = [[5000, 0.0004], [1000, 0]]",
      "lambda greater than 0 and at most 1e+06 s"}},
    {"no_modes",
     model("upper-convected-maxwell", "modes = []\n"),
     {"= []: must be 1 to 16"}},
    {"modes_as_text",
     model("upper-convected-maxwell", "modes = \"two\"\n"),
     {"viscoelasticity.modes = \"two\": must be 1 to 16 pairs"}},
    {"no_mobility",
     model("giesekus"),
     {"s.toml:17: viscoelasticity.mobility is missing: it is needed with "
      "viscoelasticity.model = \"giesekus\""}},
    {"mobility_out_of_range",
     model("giesekus", fluid + "mobility = 1.2\n"),
     {"s.toml:21: viscoelasticity.mobility = 1.2: must be from 0 to 1"}},
    {"mobility_of_maxwell",
     with(fluid + "mobility = 0.1\n"),
     {"s.toml:20: viscoelasticity.mobility = 0.1 has no meaning with viscoelasticity.model "
      "= \"maxwell\". Remove it"}},
    {"no_solvent",
     model("oldroyd-b"),
     {"viscoelasticity.solvent_viscosity is missing: it is needed with "
      "viscoelasticity.model = \"oldroyd-b\""}},
    {"solvent_of_maxwell",
     model("upper-convected-maxwell", fluid + "solvent_viscosity = 0.1\n"),
     {"viscoelasticity.solvent_viscosity = 0.1 Pa s has no meaning with"}},
    {"no_extensibility",
     model("fene-p"),
     {"viscoelasticity.extensibility is missing: it is needed with", "greater than 3",
      "L2"}},
    {"too_short_springs",
     model("fene-p", fluid + "extensibility = 3\n"),
     {"s.toml:21: viscoelasticity.extensibility = 3: must be greater than 3 and at most "
      "1e+09"}},
    {"no_consistency",
     model("herschel-bulkley", fluid + "flow_index = 0.5\n"),
     {"viscoelasticity.consistency is missing"}},
    {"no_flow_index",
     model("herschel-bulkley", fluid + "consistency = 0.5\n"),
     {"viscoelasticity.flow_index is missing"}},
    {"flow_index_of_zero",
     model("herschel-bulkley", fluid + "consistency = 0.5\nflow_index = 0\n"),
     {"viscoelasticity.flow_index = 0: must be greater than 0 and at most 3"}},
    {"a_yield_stress_that_jumps",
     model("herschel-bulkley", curve + "yield_stress = 100\n"),
     {"s.toml:23: viscoelasticity.yield_stress = 100 Pa needs "
      "viscoelasticity.regularization"}},
    {"nothing_to_regularize",
     model("herschel-bulkley", curve + "regularization = 0.01\n"),
     {"viscoelasticity.regularization = 0.01 s has no meaning without"}},
    {"a_curve_without_relaxation_time",
     model("herschel-bulkley",
           "elastic_modulus = 0\nviscosity = 2\nconsistency = 20\nflow_index = 0.5\n"),
     {"s.toml:19: viscoelasticity.elastic_modulus = 0 Pa: must be greater than 0 Pa with "
      "viscoelasticity.model = \"herschel-bulkley\""}},
    {"curve_of_kelvin_voigt",
     model("kelvin-voigt", curve),
     {"viscoelasticity.consistency = 20 Pa s^n has no meaning with viscoelasticity.model = "
      "\"kelvin-voigt\""}},
};
class WrongRheologies : public testing::TestWithParam<Wrong> {};
TEST_P(WrongRheologies, are_refused_with_key_value_unit_and_range) {
  expect_all(complaint_about(GetParam().text), GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(All, WrongRheologies, testing::ValuesIn(wrong_models),
                         [](const auto& wrong) { return wrong.param.name; });

TEST(WrongRheologies, without_a_stress_that_is_integrated_has_no_keys_for_it) {
  const std::string text = model("kelvin-voigt");
  expect_all(complaint_about(text, {"integrator.stress_scale=5"}),
             {"integrator.stress_scale = 5 Pa has no meaning with viscoelasticity.model = "
              "\"kelvin-voigt\""});
  expect_all(complaint_about(text, {"refinement.length=2e-3", "refinement.interval=1e-3",
                                    "refinement.stress=spline"}),
             {"refinement.stress = \"spline\" has no meaning with viscoelasticity.model"});
  const std::vector<std::string> pump{"nozzle.inflow=pump",
                                      "nozzle.flow_rate=1e-8",
                                      "nozzle.velocity=",
                                      "nozzle.nozzle_stress=10",
                                      "coulomb.near_field=free-surface",
                                      "coulomb.softened_pairs=true"};
  EXPECT_EQ(complaint_about(text, pump), "(accepted)");
  expect_all(
      complaint_about(model("kelvin-voigt", "elastic_modulus = 0\nviscosity = 1\n"), pump),
      {"nozzle.nozzle_stress = 10 Pa and viscoelasticity.elastic_modulus = 0 Pa"});
}

TEST(RheologyScenes, have_their_own_rates) {
  const auto rates = [](const std::string& text) {
    const Scene scene = read(text);
    return chain_rates(scene.config, link_state(scene));
  };
  const ChainRates scalar = rates(good_scene);
  const ChainRates tensor =
      rates(model("upper-convected-maxwell", "modes = [[4e3, 4e-4], [1e3, 1e-4]]\n"));
  EXPECT_NEAR(*tensor.relaxation, 1e4, 1e-8);
  EXPECT_NEAR(*tensor.elastic / *scalar.elastic, std::sqrt(3), 1e-12);
  EXPECT_FALSE(scalar.damping || tensor.damping);
  const ChainRates body = rates(model("kelvin-voigt"));
  EXPECT_EQ(body.elastic, scalar.elastic);
  EXPECT_FALSE(body.relaxation);
  EXPECT_NEAR(*body.damping, *scalar.viscous, 1e-9 * *scalar.viscous);
  const ChainRates solvent = rates(model("oldroyd-b", fluid + "solvent_viscosity = 2\n"));
  EXPECT_NEAR(*solvent.damping, 3 * *scalar.viscous, 1e-9 * *solvent.damping);
}

TEST(RheologyScenes, with_a_thick_dashpot_are_refused_to_explicit_methods) {
  const std::string text =
      model("kelvin-voigt", "elastic_modulus = 5e3\nviscosity = 1e5\n");
  expect_all(
      complaint_about(text, {"integrator.method=dormand-prince"}),
      {"integrator.method = \"dormand-prince\": viscosity damps links of 0.0002 m at",
       "\"ros34pw2\""});
  EXPECT_EQ(complaint_about(text), "(accepted)");
}

} // namespace
} // namespace ehdjet
