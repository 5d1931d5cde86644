#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/scene/schema.hpp"

#include <filesystem>

#include "support.hpp"

namespace ehdjet {
namespace {

const std::filesystem::path scenes = EHDJET_SCENES;

std::vector<std::filesystem::path> all_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(scenes))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

TEST(ReadScene, an_absent_table_is_an_absent_feature) {
  const Scene s = read("[run]\nend_time = 1\n[nozzle]\nradius = 5e-5\nlink_length = 2e-4\n"
                       "velocity = 0\ndensity = 840\ncharge_density = 0\n");
  EXPECT_FALSE(s.config.chain || s.config.collector || s.config.field || s.config.gravity
               || s.config.coulomb || s.config.viscoelasticity || s.config.surface_tension
               || s.config.output.observables || s.config.output.frames
               || s.config.output.deposit);
  EXPECT_EQ(s.chain.size(), 0u);
}

TEST(ReadScene, every_number_arrives_where_it_belongs) {
  const SceneConfig c = read(good_scene).config;
  EXPECT_EQ(c.title, "good");
  EXPECT_EQ(c.run.end_time, 0.01);
  EXPECT_EQ(c.nozzle->radius, 5e-5);
  EXPECT_EQ(c.nozzle->density, 840); // an integer in the file
  EXPECT_EQ(c.collector->distance, 0.16);
  EXPECT_EQ(c.field->potential, 9000);
  EXPECT_FALSE(c.field->strength);
  EXPECT_EQ(c.coulomb->solver, "direct");
  EXPECT_EQ(c.viscoelasticity->viscosity, 2);
  EXPECT_EQ(c.surface_tension->form, SurfaceTensionForm::paper);
  EXPECT_EQ(c.integrator.rtol, 1e-5);
  EXPECT_FALSE(c.integrator.step);
  EXPECT_EQ(c.output.observables, 1e-4);
}

TEST(ReadScene, the_text_is_kept_byte_for_byte) {
  const std::string text = "# comment\r\n" + good_scene;
  EXPECT_EQ(read(text, {"nozzle.radius=4e-5"}).given, text);
}

TEST(ReadScene, steps_are_adaptive_unless_a_step_is_given) {
  EXPECT_EQ(read(good_scene_but("rtol = 1e-5\n", "")).config.integrator.rtol, 1e-6);
  const auto fixed = read(good_scene_but("rtol = 1e-5", "method = \"rk4\"\nstep = 1e-8"))
                         .config.integrator;
  EXPECT_EQ(fixed.step, 1e-8);
  EXPECT_FALSE(fixed.rtol);
}

TEST(ReadScene, every_method_is_accepted_with_what_it_needs) {
  for (const ehdjet::IntegratorDescription& method : ehdjet::integration_methods()) {
    const std::string line = "method = \"" + std::string(method.name) + "\"\n";
    EXPECT_EQ(complaint_about(good_scene_but("rtol = 1e-5", line + "step = 1e-8"))
                  == "(accepted)",
              method.kind != ehdjet::MethodKind::chooses);
    EXPECT_EQ(complaint_about(good_scene_but("rtol = 1e-5", line + "rtol = 1e-8"))
                  == "(accepted)",
              method.estimates_errors);
  }
}

// An inviscid fluid and a chain that nothing moves are limits, not errors.
TEST(ReadScene, zero_viscosity_modulus_charge_and_velocity_are_allowed) {
  EXPECT_EQ(complaint_about(good_scene,
                            {"viscoelasticity.viscosity=0",
                             "viscoelasticity.elastic_modulus=0", "nozzle.charge_density=0",
                             "nozzle.velocity=0", "field=", "coulomb=", "gravity="}),
            "(accepted)");
}

TEST(ReadScene, extreme_but_possible_jets_are_allowed) {
  EXPECT_EQ(
      complaint_about(good_scene, {"viscoelasticity.elastic_modulus=1e12",
                                   "viscoelasticity.viscosity=1e6", "field.potential=1.6e7",
                                   "nozzle.link_length=1e-9", "nozzle.radius=2.5e-10",
                                   "nozzle.charge_density=1e-150"}),
      "(accepted)");
}

TEST(Overrides, replace_add_and_remove_keys_and_tables) {
  const SceneConfig c =
      read(good_scene,
           {"nozzle.radius=4e-5", "surface_tension.form=line", "output.frames=1",
            "title=two words", "gravity=", "integrator.rtol=", "integrator.step=1e-7",
            "integrator.method=rk4", "field={strength=5}"})
          .config;
  EXPECT_EQ(c.nozzle->radius, 4e-5);
  EXPECT_EQ(c.surface_tension->form, SurfaceTensionForm::line); // a bare word is a string
  EXPECT_EQ(c.output.frames, 1);
  EXPECT_EQ(c.title, "two words");
  EXPECT_FALSE(c.gravity);
  EXPECT_FALSE(c.integrator.rtol);
  EXPECT_EQ(c.integrator.step, 1e-7);
  EXPECT_EQ(c.field->strength, 5);
  EXPECT_FALSE(c.field->potential);
}

TEST(Overrides, are_named_as_the_source_of_what_is_wrong_with_them) {
  expect_all(
      complaint_about(good_scene, {"nozzle.radius=-1e-5"}),
      {"--set nozzle.radius=-1e-5: nozzle.radius = -1e-05 m: must be greater than 0"});
  expect_all(
      complaint_about(good_scene, {"nozzle.radus=1"}),
      {"--set nozzle.radus=1: unknown key nozzle.radus", "did you mean nozzle.radius?"});
  expect_all(complaint_about(good_scene, {"nozle.radius=1"}),
             {"--set nozle.radius=1: unknown table [nozle]", "did you mean [nozzle]?"});
  expect_all(complaint_about(good_scene, {"nozzle.radius=thin"}),
             {"--set nozzle.radius=thin: nozzle.radius = \"thin\": must be a number"});
  for (const char* bad : {"nozzle.radius", "=1", ".radius=1", "nozzle.=1"})
    expect_all(complaint_about(good_scene, {bad}),
               {"--set ", bad, "expected table.key=value"});
  expect_all(complaint_about(good_scene, {"nozzle.radius=[1"}),
             {"--set nozzle.radius=[1: `[1` is not a TOML value"});
  expect_all(complaint_about(good_scene, {"title.text=1"}), {"title is not a table"});
}

TEST(ShippedScenes, read_without_complaint) {
  ASSERT_GE(all_scenes().size(), 4u);
  for (const auto& file : all_scenes())
    EXPECT_EQ(complaint([&] { read_scene(file); }), "(accepted)") << file;
}

TEST(ShippedScenes, resolved_text_reads_back_to_the_same_configuration) {
  for (const auto& file : all_scenes()) {
    const SceneConfig c = read_scene(file).config;
    const std::string resolved = resolved_toml(c);
    EXPECT_EQ(read_scene_text(resolved, "resolved", scenes).config, c) << resolved;
  }
}

TEST(ResolvedToml, keeps_every_bit_and_every_character) {
  SceneConfig c = read(good_scene, {"integrator.rtol=", "integrator.step=1.1e-8",
                                    "integrator.method=dop853"})
                      .config;
  c.title = "quotes \" backslash \\ new\nline, tab\t, rho = \xcf\x81";
  c.nozzle->radius = 5e-5 / 3;
  c.nozzle->phase = -0.1;
  c.nozzle->insertion_velocity = InsertionVelocity::nozzle;
  c.integrator.norm = ErrorNorm::rms;
  c.integrator.events = EventPlacement::step_end;
  c.run.threads = 3;
  c.output.deposit = true;
  c.collector->velocity = {0, 2. / 3, -1e-3};
  EXPECT_EQ(read(resolved_toml(c)).config, c);
}

TEST(ResolvedToml, says_unit_and_meaning_of_each_key) {
  expect_all(
      resolved_toml(read(good_scene).config),
      {"radius = 5e-05", "# [m] jet radius at the nozzle, a0", "# step: `rtol` is given"});
}

/// Collects "table" and "key" names independently of the pages made from the schema.
struct Collector {
  std::vector<std::string> tables, keys;
  template <class... Rest>
  void required(std::string_view name, const Rest&...) {
    keys.emplace_back(name);
  }
  template <class... Rest>
  void optional(std::string_view name, const Rest&...) {
    keys.emplace_back(name);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) {
    table(name, config.emplace(), meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view) {
    tables.emplace_back(name);
    describe(*this, config);
  }
};

TEST(KeyReference, lists_every_table_and_key) {
  Collector all;
  SceneConfig config;
  describe(all, config);
  EXPECT_EQ(all.tables.size(), 16u);
  const std::string page = key_reference();
  for (const auto& table : all.tables) expect_all(page, {"## [" + table + "]"});
  for (const auto& key : all.keys) expect_all(page, {"| `" + key + "` |"});
  expect_all(
      page,
      {"| `radius` | m | greater than 0 and at most 0.002 | **required** | jet radius"});
}

} // namespace
} // namespace ehdjet
