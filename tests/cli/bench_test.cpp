#include <gtest/gtest.h>

#include <algorithm>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;

const std::string table2 = "bench table2 --scenes " EHDJET_SCENES " ";

TEST(BenchTable2, writes_its_rows_next_to_the_paper_s) {
  const Folder folder;
  const Outcome o =
      command(folder, table2 + "--rows none,0.8 --time 3e-3 --threads 1 --rtol 1e-4 -o t");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("8787"), HasSubstr("12718"), HasSubstr("t.csv")));
  const std::string csv = text_of(folder / "t.csv");
  EXPECT_THAT(csv, AllOf(HasSubstr("refinement_length_cm,rates,simulated_s,links_mean"),
                         HasSubstr("\n0.8,1,0.003,"), HasSubstr("\n0.8,2,0.003,"),
                         HasSubstr(",150,24,8787,0.26\n")));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(text_of(folder / "t.md"), HasSubstr("| 0.8 |"));
}

TEST(BenchTable2, goes_to_finer_meshes_than_the_paper_and_states_the_growth) {
  const Folder folder;
  const Outcome o = command(
      folder,
      table2 + "--rows 0.2,0.1 --rates two --time 4e-3 --threads 1 --rtol 1e-4 -o t");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(text_of(folder / "t.csv"),
              AllOf(HasSubstr("\n0.2,2,"), HasSubstr("\n0.1,2,"), HasSubstr(",,,\n")));
  EXPECT_THAT(o.out, HasSubstr("grows with the links to the power"));
  EXPECT_EQ(command(folder, table2 + "--rates three").exit_code, 2);
  EXPECT_EQ(command(folder, table2 + "--method auto").exit_code, 2);
  EXPECT_EQ(command(folder, table2 + "--set 'integrator.method=\"two-rate\"'").exit_code,
            2);
  EXPECT_EQ(command(folder, table2 + "--rates two --method rk4").exit_code, 2);
}

TEST(BenchTable2, refuses_what_it_does_not_know_and_overwrites_nothing) {
  const Folder folder;
  EXPECT_EQ(command(folder, table2 + "--rows 0.3").exit_code, 2);
  EXPECT_EQ(command(folder, table2 + "--solver magic").exit_code, 2);
  EXPECT_EQ(command(folder, table2 + "--rtol -1").exit_code, 2);
  folder.file("table2.csv", "precious");
  const Outcome o = command(folder, table2 + "--rows none --time 1e-4");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("table2.csv"));
  EXPECT_EQ(text_of(folder / "table2.csv"), "precious");
}

TEST(Export, has_the_budget_of_a_run_that_was_asked_for_one) {
  const Folder folder;
  const std::string run = "run " EHDJET_SCENES "/quickstart.toml --quiet --set "
                          "run.end_time=1e-3 --set integrator.rtol=1e-6 -o b.h5";
  ASSERT_EQ(command(folder, run).exit_code, 0);
  const Outcome none = command(folder, "export b.h5 --budget");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("output.budget"));
  const Outcome o = command(folder, run + " --force --set output.budget=2e-4");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const Outcome table = command(folder, "export b.h5 --budget");
  EXPECT_THAT(table.out, testing::StartsWith("time_s,kinetic_energy_j,field_energy_j,"));
  EXPECT_THAT(table.out, HasSubstr(",energy_residual_relative,momentum_x_kg_m_s,"));
  EXPECT_EQ(std::ranges::count(table.out, '\n'), 1 + 6);
}

TEST(Export, has_refinements_and_resolving_power_of_a_refined_run) {
  const Folder folder;
  const Outcome o = command(folder, "run " EHDJET_SCENES
                                    "/table2_04.toml --quiet --set run.end_time=5e-3 --set "
                                    "integrator.rtol=1e-4 -o t.h5");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(command(folder, "export t.h5 --refinements").out,
              HasSubstr("time_s,kept,beads_before,beads_after"));
  EXPECT_THAT(command(folder, "export t.h5 --resolving-power --from 4e-3").out,
              HasSubstr("lambda,mean_r,min_r\n0,"));
  EXPECT_EQ(command(folder, "export t.h5 --observables --from 4e-3").exit_code, 2);
}

} // namespace
