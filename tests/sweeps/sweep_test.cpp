#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/sweeps/sweep.hpp"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

#include "support/complaint.hpp"
#include "support/folder.hpp"

namespace ehdjet {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string pvp = "scene = \"" EHDJET_SCENES "/quickstart.toml\"\nname = \"jet\"\n";

std::vector<std::string> ids(const Sweep& sweep) {
  std::vector<std::string> list;
  for (const SweepRun& run : sweep.runs) list.push_back(run.id);
  return list;
}

/// The sweep of a plan whose first two lines are scene and name.
Sweep swept(const test::Folder& folder, const std::string& plan) {
  return read_sweep(folder.file("plan.toml", pvp + plan), folder / "out");
}

TEST(Sweep, is_a_grid_in_the_order_of_the_plan_with_the_last_key_fastest) {
  const test::Folder folder;
  const Sweep sweep = swept(folder, "[grid]\nviscoelasticity.viscosity = [2, 0.5]\n"
                                    "field.potential = [9000, 6e3]\n");
  EXPECT_THAT(sweep.keys, ElementsAre("viscoelasticity.viscosity", "field.potential"));
  EXPECT_THAT(ids(sweep), ElementsAre("jet_viscosity-2_potential-9000",
                                      "jet_viscosity-2_potential-6000",
                                      "jet_viscosity-0.5_potential-9000",
                                      "jet_viscosity-0.5_potential-6000"));
  EXPECT_EQ(sweep.index().substr(0, sweep.index().find('\n', 100) + 1),
            "id,scene,run,viscoelasticity.viscosity_pa_s,field.potential_v\n"
            "jet_viscosity-2_potential-9000,jet_viscosity-2_potential-9000.toml,"
            "jet_viscosity-2_potential-9000.h5,2,9000\n");
}

TEST(Sweep, a_scene_of_it_is_that_of_the_same_overrides) {
  const test::Folder folder;
  const Sweep sweep = swept(
      folder,
      "[set]\nrun.end_time = 3e-3\ntitle = \"a \\\"b\\\"\"\n"
      "[grid]\nfield.potential = [9000, 6000.5]\ncollector.velocity = [[0, -0.1, 2]]\n"
      "coulomb.solver = [\"fmm\"]\n");
  EXPECT_THAT(ids(sweep)[1], "jet_potential-6000.5_velocity-0_-0.1_2_solver-fmm");
  const Scene made = read_scene_text(sweep.runs[1].scene, "made", folder / "out");
  const Scene same =
      read_scene(EHDJET_SCENES "/quickstart.toml",
                 {"run.end_time=3e-3", "title=\"a \\\"b\\\"\"", "field.potential=6000.5",
                  "collector.velocity=[0,-0.1,2]", "coulomb.solver=fmm"});
  EXPECT_EQ(made.config, same.config);
  EXPECT_NE(made.config, read_scene(EHDJET_SCENES "/quickstart.toml").config);
}

TEST(Sweep, ranges_have_exact_ends_and_round_values) {
  const test::Folder folder;
  const Sweep sweep =
      swept(folder,
            "[grid]\nviscoelasticity.viscosity = { from = 0.1, to = 100, count = 4, "
            "spacing = \"log\" }\nnozzle.amplitude = { from = 0, to = 3e-5, count = 4 }\n");
  ASSERT_EQ(sweep.runs.size(), 16u);
  std::vector<std::string> viscosity, amplitude;
  for (std::size_t i = 0; i < 4; ++i) {
    viscosity.push_back(sweep.runs[4 * i].values[0]);
    amplitude.push_back(sweep.runs[i].values[1]);
  }
  EXPECT_THAT(viscosity, ElementsAre("0.1", "1", "10", "100"));
  EXPECT_THAT(amplitude, ElementsAre("0", "1e-05", "2e-05", "3e-05"));
}

TEST(Sweep, lists_go_together_and_runs_repeat) {
  const test::Folder folder;
  const Sweep sweep =
      swept(folder, "repeats = 2\n[[together]]\nlabel = [\"coarse\", \"fine\"]\n"
                    "nozzle.link_length = [4e-4, 2e-4]\nintegrator.rtol = [1e-4, 1e-6]\n"
                    "[[together]]\nnozzle.density = [840, 900]\nair.density = [1, 1]\n");
  EXPECT_THAT(sweep.keys, ElementsAre("nozzle.link_length", "integrator.rtol",
                                      "nozzle.density", "air.density"));
  ASSERT_EQ(sweep.runs.size(), 8u);
  EXPECT_EQ(sweep.runs[1].id, "jet_coarse_nozzle.density-840_air.density-1_repeat-2");
  EXPECT_EQ(sweep.runs[0].scene, sweep.runs[1].scene);
  EXPECT_THAT(sweep.runs[6].values, ElementsAre("0.0002", "1e-06", "900", "1"));
}

TEST(Sweep, files_in_a_scene_are_found_from_the_new_folder) {
  const test::Folder folder;
  const Sweep sweep =
      read_sweep(folder.file("plan.toml", "scene = \"" EHDJET_SCENES "/startup.toml\"\n"
                                          "[grid]\nrun.end_time = [1e-3, 2e-3]\n"),
                 folder / "out/deeper");
  ASSERT_EQ(sweep.runs.size(), 2u);
  write_sweep(sweep, folder / "out/deeper", false);
  const Scene made = read_scene(folder / "out/deeper/startup_end_time-0.001.toml");
  EXPECT_EQ(made.chain.x, read_scene(EHDJET_SCENES "/startup.toml").chain.x);
}

TEST(Sweep, wrong_plans_are_refused_with_file_line_key_value_and_range) {
  const test::Folder folder;
  struct Wrong {
    const char *plan, *line, *what;
  };
  const Wrong wrong[] = {
      // Of the scene: values out of range, unknown keys, keys that contradict each other.
      {"[grid]\nfield.potential = [9000,\n1e20]\n",
       "plan.toml:5: ", "field.potential = 1e+20 V: must be from -1e+08 to 1e+08 V"},
      {"[grid]\nfield.potental = [9000]\n",
       "plan.toml:4: ", "unknown key field.potental (did you mean field.potential?)"},
      {"[set]\nviscoelasticity.viscosity = -1\n[grid]\nfield.potential = [9000]\n",
       "plan.toml:4: ", "viscoelasticity.viscosity = -1 Pa s: must be"},
      {"[grid]\nfield.strength = [5e4]\n", "plan.toml:4", "field.potential"},
      {"[grid]\narray.rows = [1.5]\n",
       "plan.toml:4: ", "array.rows = 1.5: must be a whole"},
      // Of the plan.
      {"", "plan.toml: ", "[grid] or [[together]] is missing"},
      {"grids = 1\n", "plan.toml:3: ", "unknown key grids of a plan (known: scene, name,"},
      {"repeats = 0\n[grid]\nfield.potential = [1]\n",
       "plan.toml:3: ", "repeats = 0: must be a whole number from 1 to 1000"},
      {"[grid]\nfield.potential = 9000\n", "plan.toml:4: ", "belongs into [set]"},
      {"[grid]\nfield.potential = []\n", "plan.toml:4: ", "must be a list of values"},
      {"[grid]\npotential = [1]\n",
       "plan.toml:4: ", "potential: expected a key of a scene"},
      {"[grid]\nfield.potential = [1, 2, 1]\n",
       "plan.toml:4: ", "field.potential = 1: stands twice"},
      {"[grid]\nfield.potential = [{ a = 1 }]\n",
       "plan.toml:4: ", "a value must be a number"},
      {"[grid]\nfield.potential = { from = 1, to = 2 }\n",
       "plan.toml:4: ", "needs `count`"},
      {"[grid]\nfield.potential = { from = 1, to = 2, count = 1 }\n",
       "plan.toml:4: ", "field.potential: count = 1: must be a whole number from 2 to"},
      {"[grid]\nfield.potential = { from = -1, to = 2, count = 3, spacing = \"log\" }\n",
       "plan.toml:4: ", "from = -1, to = 2: must be different numbers of the same sign"},
      {"[grid]\nfield.potential = { from = 1, to = 2, n = 3 }\n",
       "plan.toml:4: ", "unknown key n of a range"},
      {"[grid]\nfield.potential = { from = 1, to = 2, count = 3, spacing = \"lin\" }\n",
       "plan.toml:4: ", "spacing must be"},
      {"[[together]]\nfield.potential = [1, 2]\nnozzle.radius = [1e-5]\n",
       "plan.toml:5: ", "nozzle.radius has 1 values, but field.potential has 2"},
      {"[[together]]\nlabel = [\"a\"]\nfield.potential = [1, 2]\n",
       "plan.toml:4: ", "label: must be a list of 2 texts"},
      {"[[together]]\nlabel = [\"a\", \"b/c\"]\nfield.potential = [1, 2]\n",
       "plan.toml:4: ", "letters, digits"},
      {"[set]\nfield.potential = 3\n[grid]\nfield.potential = [1, 2]\n",
       "plan.toml:6: ", "field.potential is given in"},
      {"[grid]\nfield.potential = { from = 1, to = 9999, count = 9999 }\n"
       "nozzle.amplitude = { from = 0, to = 1e-5, count = 9999 }\n",
       "plan.toml: ", "more than 100000 runs"},
      {"[grid]\nfield.potential = [1\n", "plan.toml:4:", "parsing array"}};
  for (const Wrong& w : wrong)
    EXPECT_THAT(complaint([&] { swept(folder, w.plan); }),
                AllOf(HasSubstr(w.line), HasSubstr(w.what)))
        << w.plan;
}

TEST(Sweep, the_same_plan_again_does_nothing_and_another_one_is_refused) {
  const test::Folder folder;
  const auto out = folder / "out";
  const std::string before = "[grid]\nfield.potential = [9000, 6000]\n",
                    after = "[grid]\nfield.potential = [9000, 8000, 7000]\n";
  EXPECT_EQ(write_sweep(swept(folder, before), out, false).written, 2u);
  const std::string kept = "jet_potential-9000.toml", old = "jet_potential-6000.toml";
  const auto written_at = std::filesystem::last_write_time(out / kept);
  EXPECT_EQ(write_sweep(swept(folder, before), out, false).written, 0u);
  EXPECT_EQ(std::filesystem::last_write_time(out / kept), written_at);

  EXPECT_THAT(complaint([&] { write_sweep(swept(folder, after), out, false); }),
              AllOf(HasSubstr("index.csv"), HasSubstr("--force"))); // it would lose a run
  EXPECT_FALSE(std::filesystem::exists(out / "jet_potential-8000.toml"));

  const SweepFiles forced = write_sweep(swept(folder, after), out, true);
  EXPECT_EQ(forced.written, 2u);
  EXPECT_EQ(forced.unchanged, 1u);
  EXPECT_THAT(forced.dropped, ElementsAre(old));
  EXPECT_EQ(std::filesystem::last_write_time(out / kept), written_at);
  EXPECT_TRUE(std::filesystem::exists(out / old));

  std::filesystem::remove(out / kept); // a file that is missing is written again
  EXPECT_EQ(write_sweep(swept(folder, after), out, false).written, 1u);
}

} // namespace
} // namespace ehdjet
