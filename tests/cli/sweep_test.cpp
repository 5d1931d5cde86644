#include <gtest/gtest.h>

#include <filesystem>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;

const std::string plan =
    "scene = \"" EHDJET_SCENES "/quickstart.toml\"\nname = \"jet\"\n"
    "[set]\nrun.end_time = 1e-4\n[grid]\nfield.potential = [9000, 8000]\n";

TEST(Sweep, writes_scenes_that_run_and_gather_makes_a_table_of_them) {
  const Folder folder;
  folder.file("plan.toml", plan);
  const Outcome made = command(folder, "sweep plan.toml");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, "2 runs, 2 scene files written; list of runs: plan/index.csv\n");
  EXPECT_EQ(command(folder, "sweep plan.toml").out,
            "2 runs, nothing to do: plan is up to date\n");
  const std::string scene = "plan/jet_potential-8000";
  ASSERT_EQ(
      command(folder, "run " + scene + ".toml -o " + scene + ".h5 --threads 1 --quiet")
          .exit_code,
      0);
  const Outcome gathered =
      command(folder, "gather " + scene + ".h5 plan/jet_potential-9000.h5 -o table.csv");
  ASSERT_EQ(gathered.exit_code, 0) << gathered.err; // one of the files is missing
  EXPECT_EQ(gathered.out, "2 runs, 1 of them complete; written to table.csv\n");
  EXPECT_THAT(text_of(folder / "table.csv"),
              AllOf(HasSubstr(scene + ".h5,complete,"),
                    HasSubstr("plan/jet_potential-9000.h5,unreadable,")));
  EXPECT_EQ(command(folder, "gather " + scene + ".h5 -o table.csv").exit_code, 2);
  EXPECT_EQ(command(folder, "gather " + scene + ".h5 --json").out.front(), '[');
}

TEST(Sweep, a_wrong_plan_writes_nothing) {
  const Folder folder;
  folder.file("plan.toml", plan + "nozzle.radius = [5e-5, 5]\n");
  const Outcome o = command(folder, "sweep plan.toml -o out");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("plan.toml:7: nozzle.radius = 5 m: must be"),
                           HasSubstr("in SI units")));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Sweep, another_plan_for_the_same_folder_needs_force) {
  const Folder folder;
  folder.file("plan.toml", plan);
  ASSERT_EQ(command(folder, "sweep plan.toml").exit_code, 0);
  folder.file("plan.toml", plan + "nozzle.radius = [5e-5]\n");
  const Outcome refused = command(folder, "sweep plan.toml");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("plan/index.csv"), HasSubstr("--force")));
  const Outcome forced = command(folder, "sweep plan.toml --force");
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_THAT(forced.err, HasSubstr("plan/jet_potential-8000.toml is of a former plan"));
}

TEST(Gather, never_overwrites_what_it_reads) {
  const Folder folder;
  folder.file("a.h5", "precious");
  const Outcome o = command(folder, "gather a.h5 -o a.h5 --force");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_EQ(text_of(folder / "a.h5"), "precious");
}

TEST(Gather, a_time_that_is_no_number_is_refused) {
  const Folder folder;
  for (const std::string option : {"--from", "--to"})
    EXPECT_THAT(command(folder, "gather a.h5 " + option + " nan").err, HasSubstr(option));
}

TEST(Gather, an_empty_window_is_refused) {
  const Folder folder;
  const Outcome o = command(folder, "gather a.h5 --from 2 --to 1");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("--from 2 s"), HasSubstr("--to 1 s")));
}

} // namespace
