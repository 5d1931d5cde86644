#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string quickstart = EHDJET_SCENES "/quickstart.toml";
const std::string brief =
    quickstart + " --set run.end_time=5e-4 --set output.observables=1e-4";

TEST(Run, ends_with_a_summary_and_a_file) {
  const Folder folder;
  const Outcome o = command(folder, "run " + brief + " -o jet.h5");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  for (const char* word :
       {"beads", "tip", "path length", "events", "evaluations", "jet.h5"})
    EXPECT_THAT(o.out, HasSubstr(word));
  EXPECT_THAT(command(folder, "export jet.h5 --observables").out,
              HasSubstr("time_s,beads,tip_x_m"));
}

// Who chose the method is told how it went, who named one knows.
TEST(Run, says_which_method_was_chosen) {
  const Folder folder;
  const Outcome chosen = command(folder, "run " + brief + " -o chosen.h5");
  EXPECT_THAT(chosen.out, HasSubstr("auto: dormand-prince since t = 0 s, 0 changes"));
  const Outcome stiff =
      command(folder, "run " + brief + " -o stiff.h5 --set viscoelasticity.viscosity=1e-9");
  EXPECT_THAT(stiff.out, HasSubstr("auto: ros34pw2 since t = 0 s"));
  const Outcome named = command(
      folder, "run " + brief + " -o named.h5 --set integrator.method=dormand-prince");
  EXPECT_THAT(named.out, Not(HasSubstr("integrator")));
}

TEST(Run, says_nothing_when_quiet) {
  const Folder folder;
  const Outcome o = command(folder, "run " + brief + " -o jet.h5 --quiet");
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_THAT(o.out + o.err, IsEmpty());
}

TEST(Run, keeps_an_existing_file_unless_forced) {
  const Folder folder;
  folder.file("jet.h5", "precious");
  const Outcome refused = command(folder, "run " + brief + " -o jet.h5");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("jet.h5"), HasSubstr("--force")));
  EXPECT_EQ(text_of(folder / "jet.h5"), "precious");
  EXPECT_EQ(command(folder, "run " + brief + " -o jet.h5 --force").exit_code, 0);
}

TEST(Run, refuses_an_output_that_cannot_be_written) {
  const Folder folder;
  const Outcome o = command(folder, "run " + brief + " -o no/such/folder/jet.h5");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("no/such/folder"));
}

TEST(Run, refuses_a_wrong_scene_before_anything_runs) {
  const Folder folder;
  const auto refusal = [&](const std::string& override) {
    const Outcome o = command(folder, "run " + quickstart + " -o jet.h5 --set " + override);
    EXPECT_EQ(o.exit_code, 2) << override;
    EXPECT_FALSE(std::filesystem::exists(folder / "jet.h5")) << override;
    return o.err;
  };
  EXPECT_THAT(refusal("nozzle.radus=5e-5"), HasSubstr("radius"));
  EXPECT_THAT(refusal("nozzle.radius=1e-3"),
              AllOf(HasSubstr("link_length"), HasSubstr("radius")));
  EXPECT_THAT(refusal("viscoelasticity.viscosity=nan"), HasSubstr("viscosity"));
  EXPECT_THAT(refusal("run.end_time=-1"),
              AllOf(HasSubstr("-1"), HasSubstr("greater than 0")));
  EXPECT_THAT(refusal("integrator.method=leapfrog"), HasSubstr("dormand-prince"));
  EXPECT_THAT(refusal("integrator.method=dop853 --set viscoelasticity.viscosity=1e-9"),
              AllOf(HasSubstr("relaxes"), HasSubstr("auto")));
}

TEST(Run, names_a_scene_that_is_missing_or_no_toml) {
  const Folder folder;
  const Outcome missing = command(folder, "run nowhere.toml");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.toml"));
  folder.file("broken.toml", "[run]\nend_time = = 3\n");
  const Outcome broken = command(folder, "run broken.toml");
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.err, HasSubstr("broken.toml:2"));
}

TEST(Run, that_fails_says_when_where_and_why_and_keeps_what_was_written) {
  const Folder folder;
  // A shortest step that the jet needs less than soon after its first release.
  const Outcome o = command(folder, "run " + quickstart
                                        + " -o jet.h5 --set integrator.min_step=1e-5 --set "
                                          "output.observables=1e-6");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("t = "), HasSubstr("bead"), HasSubstr("Coulomb")));
  EXPECT_THAT(o.err, HasSubstr("jet.h5"));
  EXPECT_EQ(command(folder, "export jet.h5 --observables").exit_code, 0);
}

TEST(Run, stops_cleanly_on_a_signal) {
  for (const std::string signal : {"INT", "TERM"}) {
    const Folder folder;
    const Outcome o = command(
        folder,
        "run " + std::string(EHDJET_SCENES "/pvp.toml")
            + " -o jet.h5 --set run.end_time=100 --set output.observables=1e-6",
        // --foreground: else the signal may come twice, and the second one ends it at once
        "timeout --foreground --preserve-status -s " + signal + " 2");
    EXPECT_EQ(o.exit_code, 1) << o.err;
    EXPECT_THAT(o.err,
                AllOf(HasSubstr("SIG" + signal), HasSubstr("t = "), HasSubstr("jet.h5")));
    const std::string rows = command(folder, "export jet.h5 --observables").out;
    EXPECT_GT(std::ranges::count(rows, '\n'), 100) << signal;
  }
}

TEST(Run, on_a_full_disk_fails_and_keeps_a_readable_file) {
  const Folder folder;
  // 512-byte blocks: 1 MiB. The shell ignores SIGXFSZ, so that writing fails as on a full disk.
  const Outcome o = command(
      folder,
      "run " + quickstart + " -o jet.h5 --set output.frames=1e-6 --set output.flush=0.001",
      "trap '' XFSZ; ulimit -f 2048;");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("jet.h5"), HasSubstr("at t = ")));
  EXPECT_EQ(command(folder, "export jet.h5 --beads -o beads.csv").exit_code, 0);
}

TEST(Run, gives_the_same_bits_for_the_same_threads) {
  const Folder folder;
  const auto rows = [&](const std::string& name) {
    EXPECT_EQ(command(folder, "run " + brief + " --threads 2 -o " + name).exit_code, 0);
    return command(folder, "export " + name + " --observables").out;
  };
  const std::string first = rows("a.h5");
  EXPECT_THAT(first, Not(IsEmpty()));
  EXPECT_EQ(first, rows("b.h5"));
}

TEST(Run, tells_how_many_threads_ran) {
  const Folder folder;
  const Outcome two = command(folder, "run " + brief + " --threads 2 -o two.h5");
  EXPECT_THAT(two.out, HasSubstr(" s on 2 threads"));
  EXPECT_THAT(two.err, Not(HasSubstr("OMP_THREAD_LIMIT")));
  const Outcome limited =
      command(folder, "run " + brief + " --threads 2 -o one.h5", "OMP_THREAD_LIMIT=1");
  EXPECT_THAT(limited.out, HasSubstr(" s on 1 thread\n"));
  EXPECT_THAT(limited.err, HasSubstr("1 thread runs instead of 2"));
  EXPECT_THAT(command(folder, "--version", "OMP_NUM_THREADS=8 OMP_THREAD_LIMIT=1").out,
              HasSubstr("threads    1\n"));
}

TEST(Run, warns_of_a_coincident_pair_once) {
  const Folder folder;
  folder.file("pair.toml",
              "[run]\nend_time = 1e-5\n[chain]\nfile = \"beads.csv\"\nfixed = \"none\"\n"
              "[coulomb]\n[output]\nobservables = 1e-6\n");
  folder.file("beads.csv", "x_m,y_m,z_m,mass_kg,charge_c,volume_m3\n"
                           "0,0,0,1e-9,1e-11,1e-12\n2e-4,0,0,1e-9,1e-11,1e-12\n"
                           "0,0,0,1e-9,1e-11,1e-12\n");
  const Outcome o = command(folder, "run pair.toml");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("1 pair of beads at zero distance"));
}

TEST(Run, writes_only_what_the_scene_asks_for) {
  const Folder folder;
  folder.file("bare.toml",
              "[run]\nend_time = 1e-4\n[chain]\nfile = \"beads.csv\"\n[coulomb]\n");
  folder.file("beads.csv", "x_m,y_m,z_m,mass_kg,charge_c,volume_m3\n"
                           "0,0,0,1e-9,1e-11,1e-12\n2e-4,0,0,1e-9,1e-11,1e-12\n");
  ASSERT_EQ(command(folder, "run bare.toml").exit_code, 0)
      << text_of(folder / "stderr.txt");
  const Outcome o = command(folder, "export bare.h5 --observables");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("output.observables"));
}

TEST(Command, without_or_with_an_unknown_subcommand_is_a_usage_error) {
  const Folder folder;
  EXPECT_EQ(command(folder, "").exit_code, 2);
  EXPECT_EQ(command(folder, "fly").exit_code, 2);
  EXPECT_EQ(command(folder, "run").exit_code, 2);
  EXPECT_EQ(command(folder, "--help").exit_code, 0);
}

TEST(Command, version_names_commit_compiler_simd_and_libraries) {
  const Folder folder;
  const Outcome o = command(folder, "--version");
  EXPECT_EQ(o.exit_code, 0);
  for (const char* word :
       {"ehdjet 0.", "commit", "compiler", "SIMD", "HDF5 1.", "GSL", "Eigen"})
    EXPECT_THAT(o.out, HasSubstr(word));
}

TEST(Check, shows_groups_limits_and_the_resolved_scene_without_running) {
  const Folder folder;
  const Outcome o = command(folder, "check " EHDJET_SCENES "/pvp.toml");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  for (const char* word :
       {"charge_density", "C/m^3", "13.66", "0.45127", "dormand-prince", "Coulomb"})
    EXPECT_THAT(o.out, HasSubstr(word));
  EXPECT_TRUE(std::filesystem::exists(folder / "stdout.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pvp.h5"));
}

TEST(Check, documents_every_key) {
  const Folder folder;
  const Outcome o = command(folder, "check --keys");
  EXPECT_EQ(o.exit_code, 0);
  for (const char* key :
       {"link_length", "insertion_velocity", "rtol", "observables", "fixed"})
    EXPECT_THAT(o.out, HasSubstr(key));
}

// Only GCC's OpenMP runtime spins for long, and only when it is loaded does it ask how long it may.
TEST(Threads, wait_for_a_bounded_time_unless_the_user_says_otherwise) {
#ifdef __clang__
  GTEST_SKIP();
#endif
  const Folder folder;
  const auto environment = [&](const std::string& setting) {
    return command(folder, "--version",
                   "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=VERBOSE "
                       + setting)
        .err;
  };
  EXPECT_THAT(environment(""), HasSubstr("GOMP_SPINCOUNT = '1000'"));
  EXPECT_THAT(environment("GOMP_SPINCOUNT=77"),
              AllOf(HasSubstr("GOMP_SPINCOUNT = '77'"), Not(HasSubstr("'1000'"))));
  EXPECT_THAT(environment("OMP_WAIT_POLICY=passive"), Not(HasSubstr("'1000'")));
}

// A jet that dries within five millimetres, onto a plate that moves.
TEST(Run, tells_the_dry_diameter_of_a_fibre_and_exports_its_length) {
  const Folder folder;
  const Outcome run = command(
      folder, "run " EHDJET_SCENES
              "/fibre.toml --set collector.distance=5e-3 --set field.potential=500 --set "
              "run.end_time=12e-3 --set evaporation.saturation=2 --set output.frames=6e-3 "
              "--threads 1 --set 'collector.velocity=[0,1,0]' -o f.h5");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, testing::ContainsRegex("dry diameter +[0-9.]+ um"));

  std::istringstream lines(command(folder, "export f.h5 --deposit").out);
  std::string line, field;
  std::vector<std::string> names;
  std::vector<std::map<std::string, double>> rows;
  std::getline(lines, line);
  for (std::istringstream header(line); std::getline(header, field, ',');)
    names.push_back(field);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    auto& row = rows.emplace_back();
    for (const std::string& name : names) {
      std::getline(fields, field, ',');
      row[name] = std::stod(field);
    }
  }
  ASSERT_GT(rows.size(), 10U);
  double chords = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    auto &a = rows[k - 1], &b = rows[k];
    chords += std::hypot(a["y_m"] - b["y_m"], a["z_m"] - b["z_m"]);
    EXPECT_GT(b["evaporated"], 0.1);
    EXPECT_LT(b["dry_radius_m"], b["radius_m"]);
  }
  // A link leaves the chain when both its ends rest on the plate.
  EXPECT_NEAR((rows.back()["arc_length_m"] - rows.front()["arc_length_m"]) / chords, 1,
              0.01);
}

} // namespace
