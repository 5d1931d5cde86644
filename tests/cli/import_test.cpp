#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace ehdjet::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string example(int number) {
  return "'" EHDJET_TEST_DATA "/jetspin/example" + std::to_string(number) + ".dat'";
}

TEST(ImportCommand, writes_scenes_that_check_accepts) {
  const Folder folder;
  for (int number = 1; number <= 6; ++number) {
    const std::string scene = "scene" + std::to_string(number) + ".toml";
    const Outcome import = command(folder, "import " + example(number) + " -o " + scene
                                               + (number == 4 ? " --without-noise" : ""));
    EXPECT_EQ(import.exit_code, 0) << import.err;
    EXPECT_EQ(import.out, "");
    EXPECT_THAT(import.err, HasSubstr("print list: observables have all columns"));
    EXPECT_THAT(import.err, HasSubstr("written to " + scene));
    const Outcome check = command(folder, "check " + scene);
    EXPECT_EQ(check.exit_code, 0) << number << check.err;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "scene1.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "scene2.csv"));
}

TEST(ImportCommand, writes_to_standard_output_and_overwrites_nothing) {
  const Folder folder;
  const Outcome shown = command(folder, "import " + example(3));
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_THAT(shown.out, HasSubstr("radius = 5e-05"));
  const Outcome chain = command(folder, "import " + example(1));
  EXPECT_EQ(chain.exit_code, 2);
  EXPECT_THAT(chain.err, HasSubstr("Give -o SCENE.toml"));

  folder.file("s.toml", "mine");
  for (int number : {1, 3}) {
    EXPECT_EQ(command(folder, "import " + example(number) + " -o s.toml").exit_code, 2);
    EXPECT_EQ(text_of(folder / "s.toml"), "mine");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "s.csv"));
  EXPECT_EQ(command(folder, "import " + example(1) + " -o s.toml --force").exit_code, 0);
}

TEST(ImportCommand, never_overwrites_its_input) {
  const Folder folder;
  const std::string chain = text_of(EHDJET_TEST_DATA "/jetspin/example1.dat");
  for (const std::string name : {"s.toml", "s.csv"}) { // the scene, and the beads beside it
    folder.file(name, chain);
    const Outcome o = command(folder, "import " + name + " -o s.toml --force");
    EXPECT_EQ(o.exit_code, 2) << name;
    EXPECT_EQ(text_of(folder / name), chain);
    std::filesystem::remove(folder / name);
  }
}

TEST(ImportCommand, names_file_and_line_and_leaves_nothing_behind) {
  const Folder folder;
  folder.file("input.dat", "system 3\nnozle cross 0.005\nfinish\n");
  const Outcome unknown = command(folder, "import input.dat -o s.toml");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("input.dat:2: \"nozle cross 0.005\""),
                                 HasSubstr("\"nozzle cross\"")));
  // A value that a scene may not have.
  std::string text = text_of(EHDJET_TEST_DATA "/jetspin/example1.dat");
  folder.file("input.dat", text.insert(text.find("finish"), "viscosity 1.d40\n"));
  EXPECT_EQ(command(folder, "import input.dat -o s.toml").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.csv"));
  folder.file("s.csv", "mine");
  EXPECT_EQ(command(folder, "import input.dat -o s.toml --force").exit_code, 2);
  EXPECT_EQ(text_of(folder / "s.csv"), "mine");
  for (const char* file : {"nothing.dat", "."})
    EXPECT_EQ(command(folder, std::string("import ") + file).exit_code, 2) << file;
}

// The columns are those of JETSPIN's statout.dat: nstep, t, x, yz, n, angl, lp, vn, vc, rc, curn, curc.
TEST(ImportCommand, and_its_statistics_have_jetspins_columns) {
  const Folder folder;
  ASSERT_EQ(command(folder, "import " + example(3) + " -o s.toml").exit_code, 0);
  const Outcome run = command(
      folder, "run s.toml -o s.h5 --set run.end_time=0.012 --set output.observables=1e-3");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome table = command(folder, "export s.h5 --jetspin-stat");
  ASSERT_EQ(table.exit_code, 0) << table.err;
  std::istringstream lines(table.out);
  std::string heading, line;
  std::getline(lines, heading);
  EXPECT_THAT(heading,
              HasSubstr("n          angl (deg)             lp (cm)        vn (cm s^-1)"));
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    EXPECT_EQ(line.size(), heading.size());
    std::istringstream words(line);
    rows.emplace_back();
    for (double value = 0; words >> value;) rows.back().push_back(value);
    ASSERT_EQ(rows.back().size(), 12U);
  }
  ASSERT_EQ(rows.size(), 13U);
  const std::vector<double>& first = rows.front();
  EXPECT_EQ(first[2], 0.02);
  EXPECT_EQ(first[4], 1);
  const std::vector<double>& last = rows.back();
  EXPECT_EQ(last[1], 0.012);
  EXPECT_NEAR(last[2], 16, 0.1);
  EXPECT_NEAR(last[6], 210, 20);  // cm
  EXPECT_NEAR(last[7], 221, 5);   // cm/s
  EXPECT_NEAR(last[8], 2140, 50); // cm/s
  EXPECT_NEAR(last[9], 4.1e-4, 2e-5);
  EXPECT_NEAR(last[10], 910, 80); // statC/s
  EXPECT_GT(last[11], 100);
}

} // namespace
} // namespace ehdjet::test
