#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;

TEST(Extreme, links_shorter_than_the_jet_is_wide_are_refused) {
  const Folder folder;
  const Outcome o = command(folder, "run " EHDJET_SCENES
                                    "/quickstart.toml --set nozzle.link_length=1e-8");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("nozzle.radius = 5e-05 m"),
                           HasSubstr("nozzle.link_length = 1e-08 m")));
}

// The jet of 10 nm links and a radius of 2.5 nm has the groups of the PVP jet.
TEST(Extreme, links_of_ten_nanometres_are_a_scene_like_any_other) {
  const Folder folder;
  const std::string s =
      "run " EHDJET_SCENES "/pvp.toml --quiet -o small.h5 --set run.end_time=1e-3"
      " --set nozzle.link_length=1e-8 --set nozzle.radius=2.5e-9 --set "
      "nozzle.amplitude=5e-10"
      " --set nozzle.velocity=1.414710605e-7 --set collector.distance=8e-6"
      " --set field.potential=2.25e-5 --set gravity.acceleration=4.903325e-4"
      " --set viscoelasticity.elastic_modulus=1.25e-5 --set viscoelasticity.viscosity=5e-9"
      " --set surface_tension.coefficient=2.641625e-15 --set "
      "integrator.velocity_scale=5e-5";
  EXPECT_EQ(command(folder, s).exit_code, 0);
  EXPECT_THAT(command(folder, "export small.h5 --observables").out, HasSubstr("0.001,"));
}

TEST(Extreme, a_bead_that_runs_into_the_next_one_ends_the_run_with_exit_code_1) {
  const Folder folder;
  folder.file("c.csv",
              "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,volume_m3,mass_kg,charge_c\n"
              "0,0,0,0,0,0,0,1.6e-12,1.3e-9,0\n"
              "2e-4,0,0,0,0,0,0,1.6e-12,1.3e-9,0\n"
              "4e-4,0,0,-100,0,0,0,1.6e-12,1.3e-9,0\n");
  folder.file("c.toml", "[run]\nend_time = 1e-4\n[chain]\nfile = \"c.csv\"\n"
                        "[viscoelasticity]\nelastic_modulus = 1\nviscosity = 1e-3\n"
                        "[output]\nframes = 1e-6\n");
  const Outcome o = command(folder, "run c.toml --quiet");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("t = "), HasSubstr("bead 2 runs into bead 1"),
                           HasSubstr("viscoelasticity"), HasSubstr("c.h5")));
  EXPECT_EQ(command(folder, "export c.h5 --beads").exit_code, 0);
}

// Steps and frames at binary fractions of a second: a frame is the state at the end of a step.
TEST(Extreme, a_chain_goes_on_from_a_frame_bit_for_bit) {
  const Folder folder;
  const std::string step = "9.5367431640625e-07", frames = "1.52587890625e-05";
  const auto scene = [&](const std::string& file, const std::string& end) {
    return "[run]\nend_time = " + end + "\n[chain]\nfile = \"" + file
           + "\"\nfixed = \"none\"\n[field]\nstrength = "
             "56250\n[coulomb]\n[viscoelasticity]\n"
             "elastic_modulus = 5e3\nviscosity = 2\n[surface_tension]\ncoefficient = "
             "0.021133\n"
             "[integrator]\nmethod = \"rk4\"\nstep = "
           + step + "\n[output]\nframes = " + frames + "\n";
  };
  const std::string start = EHDJET_SCENES "/chain.csv";
  folder.file("whole.toml", scene(start, "3.0517578125e-05"));
  folder.file("first.toml", scene(start, frames));
  folder.file("second.toml", scene("first.h5", frames));
  for (const char* part : {"whole", "first", "second"})
    ASSERT_EQ(
        command(folder, std::string("run --quiet --threads 1 ") + part + ".toml").exit_code,
        0)
        << part;
  const Outcome whole = command(folder, "export whole.h5 --beads"),
                second = command(folder, "export second.h5 --beads");
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_EQ(second.out, whole.out);
  EXPECT_NE(second.out, command(folder, "export first.h5 --beads").out);
}

// Of a thick thread the parts of a link that is cut are shorter than so many radii: they would be joined at once.
TEST(Refinement, of_links_that_are_joined_and_cut_again_ends) {
  const Folder folder;
  const std::string run =
      "run chain --quiet -o chain.h5 --set run.end_time=1e-4 --set refinement.length=5e-4 "
      "--set 'refinement.mesh=\"cut\"' --set refinement.shortest=20";
  EXPECT_EQ(command(folder, run, "timeout -s KILL 60").exit_code, 0);
}

} // namespace
