#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost_watch.hpp"

namespace ehdjet::cli {
namespace {

using testing::HasSubstr;

/// Looks at a run every second of the clock and keeps the warnings. `pace`: simulated time in that second.
template <class Pace>
std::vector<std::string> watch(double end_time, int seconds, const Pace& pace,
                               std::uint64_t earlier_steps = 0) {
  RunStatistics statistics;
  statistics.steps = earlier_steps;
  CostWatch costs(0, end_time, 100, statistics);
  std::vector<std::string> warnings;
  double t = 0;
  for (int wall = 1; wall <= seconds; ++wall) {
    t += pace(wall);
    statistics.steps += 100, statistics.evaluations += 700;
    if (const auto warning = costs.look(wall, t, 100, statistics))
      warnings.push_back(*warning);
  }
  return warnings;
}

TEST(CostWatch, is_silent_about_a_run_that_takes_hours) {
  EXPECT_TRUE(watch(1, 7200, [](int) { return 1.0 / 7200; }).empty());
}

TEST(CostWatch, warns_of_a_run_that_would_take_days) {
  const auto warnings = watch(1, 600, [](int) { return 1e-6; });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("11.6 days"));
  EXPECT_THAT(warnings[0], HasSubstr("run.max_wall_time"));
}

TEST(CostWatch, warns_of_a_run_that_slows_down_and_says_why) {
  const auto warnings = watch(1, 100, [](int wall) { return wall <= 10 ? 1e-3 : 1e-5; });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("steps are 1e+02 times shorter than at first"));
}

// Steps before a checkpoint from which a run goes on are not those of this run.
TEST(CostWatch, knows_that_a_run_goes_on) {
  const auto pace = [](int) { return 1e-6; };
  EXPECT_EQ(watch(1, 600, pace, 1'000'000), watch(1, 600, pace));
}

TEST(CostWatch, warns_again_only_of_something_far_worse) {
  EXPECT_EQ(watch(1, 1000, [](int wall) { return wall < 200 ? 1e-6 : 1e-9; }).size(), 2U);
}

} // namespace
} // namespace ehdjet::cli
