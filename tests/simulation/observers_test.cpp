#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "support/scenes.hpp"

// Who looks at a run sees what it asked for, and takes it away from nobody.
namespace ehdjet {
namespace {

using namespace test;

/// Counts the calls of each kind.
class Counter final : public Observer {
public:
  explicit Counter(Interest interest)
      : interest_(interest) {}
  [[nodiscard]] Interest interest() const override { return interest_; }
  void begin_step(const DenseStep& /*step*/,
                  std::span<const std::unique_ptr<Event>> /*events*/) override {
    ++begun;
  }
  void end_step(double t, double /*theta*/) override { ++ended, time = t; }
  void before_event(const Event& /*event*/, const JetState& /*jet*/) override { ++before; }
  void after_event(const Event& /*event*/, const JetState& /*jet*/) override { ++after; }
  void after_step(const JetSnapshot& snapshot) override {
    ++steps;
    EXPECT_EQ(snapshot.time, snapshot.jet.time);
    EXPECT_EQ(snapshot.columns.flat.data(), snapshot.jet.y.data());
  }
  void checkpoint(const Checkpoint& /*checkpoint*/) override { ++checkpoints; }
  std::uint64_t begun = 0, ended = 0, before = 0, after = 0, steps = 0, checkpoints = 0;
  double time = 0;

private:
  Interest interest_;
};

TEST(Observers, are_called_for_what_they_want_and_do_not_replace_each_other) {
  const auto simulation = build_simulation(case_one());
  std::vector<std::shared_ptr<Counter>> all;
  for (const bool ends : {false, true, true})
    for (const bool steps : {false, true}) {
      all.push_back(std::make_shared<Counter>(
          Interest{.ends_of_steps = ends, .steps_and_events = steps}));
      simulation->add(all.back());
    }
  std::uint64_t first_hook = 0, second_hook = 0;
  simulation->after_each_step([&](const Simulation&) { ++first_hook; });
  simulation->after_each_step([&](const Simulation&) { ++second_hook; });
  simulation->make_checkpoints(2e-4);
  simulation->run_until(1e-3);

  const RunStatistics& s = simulation->statistics();
  ASSERT_GT(s.insertions, 0U);
  EXPECT_EQ(first_hook, s.steps);
  EXPECT_EQ(second_hook, s.steps);
  for (const auto& c : all) {
    const bool ends = c->interest().ends_of_steps, steps = c->interest().steps_and_events;
    EXPECT_EQ(c->steps, ends ? s.steps : 0);
    EXPECT_EQ(c->begun, steps ? s.steps : 0);
    EXPECT_EQ(c->ended, steps ? s.steps : 0);
    EXPECT_EQ(c->before, steps ? s.insertions + s.releases : 0);
    EXPECT_EQ(c->after, c->before);
    EXPECT_EQ(c->time, steps ? 1e-3 : 0);
    EXPECT_EQ(c->checkpoints, all.front()->checkpoints);
  }
  EXPECT_GE(all.front()->checkpoints, 3U);
}

TEST(Observers, change_nothing) {
  const auto alone = build_simulation(case_one()), watched = build_simulation(case_one());
  watched->add(
      std::make_shared<Counter>(Interest{.ends_of_steps = true, .steps_and_events = true}));
  alone->run_until(1e-3), watched->run_until(1e-3);
  EXPECT_EQ(alone->jet().y, watched->jet().y);
}

// 3 * 1e-5 is more than 3e-5 in doubles, and so it is for 11 of these 30 ends.
TEST(Observers, see_the_end_of_every_run_to_a_multiple_of_their_interval) {
  for (int k = 1; k <= 30; ++k) {
    const double end = std::stod(std::to_string(k) + "e-5");
    std::vector<double> times;
    const auto simulation = build_simulation(case_one());
    simulation->add(std::make_shared<Watch>(1e-5, [&](const JetSnapshot& snapshot) {
      times.push_back(snapshot.time);
      if (times.size() == static_cast<std::size_t>(k) + 1) {
        EXPECT_EQ(snapshot.columns.flat.size(), simulation->jet().y.size());
      }
    }));
    simulation->run_until(end);
    ASSERT_EQ(times.size(), static_cast<std::size_t>(k) + 1) << end;
    EXPECT_LE(times.back(), end);
    EXPECT_NEAR(times.back() / end, 1, 1e-15);
  }
}

TEST(Observers, do_not_see_times_beyond_the_end) {
  std::vector<double> times;
  const auto simulation = build_simulation(case_one());
  simulation->add(std::make_shared<Watch>(
      1e-5, [&](const JetSnapshot& snapshot) { times.push_back(snapshot.time); }));
  simulation->run_until(2.5e-5);
  EXPECT_EQ(times.size(), 3U);
  simulation->run_until(3e-5); // goes on where it was
  EXPECT_EQ(times.size(), 4U);
  simulation->run_until(4e-5);
  EXPECT_EQ(times.size(), 5U);
}

} // namespace
} // namespace ehdjet
