#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string array = EHDJET_SCENES
    "/array_3x3.toml --threads 1 --set array.rows=1 --set array.columns=2 --set "
    "output.checkpoints=1e-3 --set output.frames=1e-3";

std::string run_to(const std::string& end_time, const std::string& more) {
  return "run " + array + " --set run.end_time=" + end_time + ' ' + more;
}

/// Numbers of a named column.
std::vector<double> column(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line, field;
  std::getline(lines, line);
  std::size_t place = 0;
  for (std::istringstream names(line); std::getline(names, field, ',') && field != name;)
    ++place;
  std::vector<double> values;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    for (std::size_t i = 0; i <= place; ++i) std::getline(fields, field, ',');
    values.push_back(std::stod(field));
  }
  return values;
}

TEST(ArrayCommand, writes_and_exports_the_jet_of_each_bead) {
  const Folder folder;
  const Outcome run = command(
      folder,
      run_to("11e-3", "--set integrator.rtol=1e-4 --set output.observables=1e-3 -o a.h5"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("jets          2"), HasSubstr("path lengths")));

  const std::string beads = command(folder, "export a.h5 --beads").out;
  const auto jet = column(beads, "jet"), bead = column(beads, "bead"),
             y = column(beads, "y_m");
  ASSERT_FALSE(jet.empty());
  EXPECT_EQ(jet.front(), 0);
  EXPECT_EQ(jet.back(), 1);
  for (std::size_t k = 0; k < jet.size(); ++k)
    if (bead[k] == 0) {
      EXPECT_NEAR(y[k], jet[k] == 0 ? -0.005 : 0.005, 2e-5);
    }

  const std::string deposit = command(folder, "export a.h5 --deposit").out;
  const auto landed = column(deposit, "jet"), along = column(deposit, "arc_length_m");
  ASSERT_GT(landed.size(), 4U);
  for (std::size_t k = 1, last = 0; k < landed.size(); ++k)
    if (landed[k] == landed[last]) {
      EXPECT_GT(along[k], along[last]);
      last = k;
    }
  EXPECT_EQ(column(command(folder, "export a.h5 --observables").out, "beads").back(),
            static_cast<double>(jet.size()));

  ASSERT_EQ(command(folder, "export a.h5 --vtk --time 5e-3").exit_code, 0);
  EXPECT_THAT(text_of(folder / "a_vtk/frame_000005.vtp"),
              AllOf(HasSubstr("NumberOfLines=\"2\""), HasSubstr("Name=\"jet\"")));
  const std::string xyz = command(folder, "export a.h5 --xyz --time 5e-3").out;
  EXPECT_THAT(xyz, HasSubstr(":jet:R:1"));
  EXPECT_NE(xyz.find("\nN "), xyz.rfind("\nN ")); // two nozzles

  // A frame of an array is no chain.
  folder.file("chain.toml", "[run]\nend_time = 1e-6\n[chain]\nfile = \"a.h5\"\n");
  EXPECT_THAT(command(folder, "check chain.toml").err, HasSubstr("is a run with [array]"));
}

TEST(ArrayCommand, goes_on_from_a_checkpoint_with_the_same_bits) {
  const Folder folder;
  ASSERT_EQ(command(folder, run_to("4e-3", "--quiet -o whole.h5")).exit_code, 0);
  ASSERT_EQ(command(folder, run_to("2.5e-3", "--quiet -o first.h5")).exit_code, 0);
  const Outcome o =
      command(folder, run_to("4e-3", "--quiet --continue first.h5 -o second.h5"));
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const std::string whole = command(folder, "export whole.h5 --beads").out;
  EXPECT_EQ(command(folder, "export second.h5 --beads").out, whole);
  EXPECT_GT(whole.size(), 1000U);
}

TEST(ArrayCommand, says_what_it_will_simulate) {
  const Folder folder;
  EXPECT_THAT(command(folder, "check " EHDJET_SCENES "/array_3x3.toml").out,
              AllOf(HasSubstr("array: 9 such jets, 3 x 3 nozzles"), HasSubstr("spacing")));
  EXPECT_THAT(command(folder, "check " EHDJET_SCENES "/pvp.toml").out,
              Not(HasSubstr("array:")));
  EXPECT_THAT(command(folder, run_to("1e-3", "--set output.budget=1e-4")).err,
              HasSubstr("output.budget and [array]"));
}

TEST(ArrayCommand, leaves_single_jets_without_a_column) {
  const Folder folder;
  const std::string run = "run " EHDJET_SCENES "/pvp.toml --quiet --set run.end_time=5e-4 "
                          "--set output.frames=5e-4 -o one.h5";
  ASSERT_EQ(command(folder, run).exit_code, 0);
  EXPECT_THAT(command(folder, "export one.h5 --beads").out, Not(HasSubstr("jet")));
}

} // namespace
