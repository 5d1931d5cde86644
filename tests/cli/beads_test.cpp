#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <gmock/gmock.h>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.hpp"

// The number of beads (model 1) is the same wherever it is said.
namespace {

using namespace ehdjet::test;
using testing::HasSubstr;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  return lines;
}

/// A cell of the last row of a CSV table.
std::string last_cell(const std::string& csv, const std::string& column) {
  const auto lines = lines_of(csv);
  std::istringstream names(lines.front()), row(lines.back());
  for (std::string name, cell;
       std::getline(names, name, ',') && std::getline(row, cell, ',');)
    if (name == column) return cell;
  return "no column " + column;
}

void expect_one_number_of_beads(const std::string& run) {
  SCOPED_TRACE(run);
  const Folder folder;
  const Outcome summary = command(folder, "run " + run + " -o jet.h5");
  ASSERT_EQ(summary.exit_code, 0) << summary.err;
  const auto output = [&](const std::string& arguments) {
    const Outcome o = command(folder, arguments);
    EXPECT_EQ(o.exit_code, 0) << arguments << o.err;
    return o.out;
  };
  const std::string beads =
      last_cell(output("export jet.h5 --observables"), "beads"); // the panel shows these
  EXPECT_GT(std::stoi(beads), 1);
  EXPECT_THAT(summary.out, HasSubstr("  beads         " + beads));
  EXPECT_EQ(lines_of(output("export jet.h5 --beads")).size() - 1, std::stoul(beads));
  EXPECT_EQ(lines_of(output("export jet.h5 --xyz --time "
                            + last_cell(output("export jet.h5 --observables"), "time_s")))
                .front(),
            beads);
  output("export jet.h5 --vtk -o jet.pvd");
  std::string last_frame;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder.path()))
    if (file.path().extension() == ".vtp")
      last_frame = std::max(last_frame, file.path().string());
  EXPECT_THAT(text_of(last_frame), HasSubstr("NumberOfPoints=\"" + beads + '"'));
  output("plot jet.h5 -o jet.svg");
  EXPECT_THAT(text_of(folder / "jet.svg"), HasSubstr(beads + " beads"));
  const std::string info = output("info jet.h5 --json");
  EXPECT_THAT(info, HasSubstr("\"beads\":" + beads));
  EXPECT_THAT(info, HasSubstr("\"beads_in_last\":" + beads));
}

const std::string scenes = EHDJET_SCENES "/";

TEST(Beads, are_the_same_in_heading_panel_summary_files_and_exports) {
  expect_one_number_of_beads(
      scenes + "quickstart.toml --set run.end_time=2e-3 --set output.frames=1e-3");
  expect_one_number_of_beads(scenes + "chain.toml");
  expect_one_number_of_beads(
      scenes + "table2_02.toml --set run.end_time=4e-3 --set output.frames=2e-3");
  expect_one_number_of_beads(
      scenes
      + "array_3x3.toml --set run.end_time=1e-3 --set output.frames=1e-3 --set "
        "output.observables=1e-3");
}

TEST(Beads, of_a_given_chain_are_those_that_are_given) {
  const Folder folder;
  const Outcome o = command(folder, "run " + scenes + "chain.toml -o jet.h5");
  EXPECT_THAT(o.out, HasSubstr("  beads         12\n"));
}

} // namespace
