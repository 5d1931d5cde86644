#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/sweeps/gather.hpp"
#include "ehdjet/sweeps/time_mean.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <gmock/gmock.h>
#include <iterator>
#include <utility>

#include "support/folder.hpp"

namespace ehdjet {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Cell = GatheredRuns::Cell;

std::filesystem::path run(const test::Folder& folder, const std::string& name,
                          std::vector<std::string> overrides, RunOptions options = {}) {
  for (const char* o : {"run.end_time=2e-4", "output.observables=1e-5", "run.threads=1"})
    overrides.insert(overrides.begin(), o);
  run_scene(read_scene(EHDJET_SCENES "/quickstart.toml", overrides), folder / name,
            std::move(options));
  return folder / name;
}

const Cell& cell(const GatheredRuns& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  if (found == table.columns.end()) throw std::runtime_error("no column " + column);
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

double number(const GatheredRuns& table, std::size_t row, const std::string& column) {
  return std::get<double>(cell(table, row, column));
}

std::string printed(const GatheredRuns& table, const std::filesystem::path& file,
                    bool json) {
  TextOutput output(file, true);
  json ? table.print_json(output) : table.print_csv(output);
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Gather, shows_what_differs_and_the_means_of_the_second_half) {
  const test::Folder folder;
  const auto a = run(folder, "a.h5", {}),
             b = run(folder, "b.h5", {"field.potential=8000", "coulomb.solver=treecode"});
  const GatheredRuns table = gather_runs({a, b});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(cell(table, 0, "run"), Cell(a.string()));
  EXPECT_EQ(cell(table, 1, "status"), Cell("complete"));
  EXPECT_EQ(number(table, 0, "field.potential_v"), 9000);
  EXPECT_EQ(number(table, 1, "field.potential_v"), 8000);
  EXPECT_EQ(cell(table, 1, "coulomb.solver"), Cell("treecode"));
  EXPECT_THAT(table.columns, Not(Contains("nozzle.radius_m")));
  EXPECT_THAT(table.columns, Not(Contains("run.end_time_s")));

  const RunReader reader(b);
  const auto time = reader.column("observables", "time"),
             path = reader.column("observables", "path_length");
  std::vector<double> late;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] >= time.back() / 2) late.push_back(path[i]);
  EXPECT_EQ(number(table, 1, "rows"), static_cast<double>(late.size()));
  EXPECT_EQ(late.size(), 11u);
  EXPECT_EQ(number(table, 1, "path_length_m"), time_mean(late).mean);
  EXPECT_EQ(number(table, 1, "path_length_error_m"), *time_mean(late).standard_error);
  EXPECT_EQ(number(table, 1, "from_s"), 1e-4);
  EXPECT_EQ(number(table, 1, "evaluations"), reader.statistics().at("evaluations"));
  EXPECT_GT(number(table, 1, "wall_time_s"), 0);
  // No bead has landed: there is no impact speed, and not one of 0 m/s.
  EXPECT_THAT(table.columns, Not(Contains("impact_speed_m_s")));
  EXPECT_THAT(table.columns, Not(Contains("evaluations_error")));
}

TEST(Gather, means_over_a_window) {
  const test::Folder folder;
  const auto a = run(folder, "a.h5", {});
  const GatheredRuns table = gather_runs({a}, {.from = 4.95e-5, .to = 7.05e-5});
  const RunReader reader(a);
  const auto tip = reader.column("observables", "tip_x");
  EXPECT_EQ(number(table, 0, "rows"), 3);
  EXPECT_NEAR(number(table, 0, "tip_x_m"), (tip[5] + tip[6] + tip[7]) / 3, 1e-18);
  EXPECT_THAT(table.columns, Not(Contains("tip_x_error_m"))); // of three values
  EXPECT_EQ(number(gather_runs({a}, {.from = 1, .to = {}}), 0, "rows"), 0);
}

TEST(Gather, has_a_row_for_every_file_whatever_it_is) {
  const test::Folder folder;
  const auto whole = run(folder, "whole.h5", {});
  RunOptions stop;
  stop.interrupted = [n = 0]() mutable { return ++n < 20 ? nullptr : "\"a\", b"; };
  const auto stopped = run(folder, "stopped.h5", {}, std::move(stop));
  std::ifstream in(whole, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::vector<std::filesystem::path> files{
      whole,
      folder / "missing.h5",
      stopped,
      folder.file("text.h5", "no run"),
      folder.file("cut.h5", bytes.substr(0, bytes.size() / 2)),
      folder / ""};
  const GatheredRuns table = gather_runs(files);
  ASSERT_EQ(table.rows.size(), files.size());
  const char* status[] = {"complete",   "unreadable", "interrupted",
                          "unreadable", "unreadable", "unreadable"};
  for (std::size_t r = 0; r < files.size(); ++r) {
    EXPECT_EQ(cell(table, r, "status"), Cell(status[r])) << files[r];
    EXPECT_EQ(table.rows[r].size(), table.columns.size());
  }
  EXPECT_THAT(std::get<std::string>(cell(table, 1, "message")),
              HasSubstr("does not exist"));
  EXPECT_THAT(std::get<std::string>(cell(table, 2, "message")), HasSubstr("stopped by"));
  EXPECT_EQ(cell(table, 3, "evaluations"), Cell());
  EXPECT_GT(number(table, 2, "evaluations"), 0);

  const std::string csv = printed(table, folder / "t.csv", false);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 7);
  EXPECT_THAT(csv, HasSubstr("interrupted,\"stopped by \"\"a\"\", b at t"));
  const std::string json = printed(table, folder / "t.json", true);
  EXPECT_THAT(json, HasSubstr("\"message\": \"stopped by \\\"a\\\", b at t"));
  EXPECT_THAT(json, HasSubstr("\"evaluations\": null"));
}

} // namespace
} // namespace ehdjet
