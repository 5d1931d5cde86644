#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "support/scenes.hpp"

// A program that takes the loop into its own hands.
namespace ehdjet {
namespace {

using namespace test;

class Times final : public Observer {
public:
  [[nodiscard]] double next_time() const override {
    return static_cast<double>(seen.size()) * 1e-4;
  }
  void observe(const JetSnapshot& snapshot) override {
    EXPECT_EQ(snapshot.time, next_time());
    seen.push_back(snapshot.columns.position().x[snapshot.jet.links()]);
  }
  std::vector<double> seen; // the tip
};

TEST(Stepping, single_steps_are_those_of_a_run) {
  const Scene scene = case_one();
  const auto run = build_simulation(scene), steps = build_simulation(scene);
  const auto of_run = std::make_shared<Times>(), of_steps = std::make_shared<Times>();
  run->add(of_run), steps->add(of_steps);

  run->run_until(1e-3);
  std::uint64_t count = 0;
  while (steps->step(1e-3)) ++count;

  EXPECT_EQ(count, run->statistics().steps);
  EXPECT_EQ(steps->jet().time, 1e-3);
  EXPECT_EQ(steps->jet().y, run->jet().y);
  EXPECT_EQ(of_steps->seen, of_run->seen);
  EXPECT_EQ(of_run->seen.size(), 11U); // the end included
}

TEST(Stepping, a_jet_that_was_handed_out_stays_in_its_place) {
  const Scene scene = case_one();
  const auto run = build_simulation(scene), other = build_simulation(scene);
  run->run_until(5e-4), other->run_until(5e-4);

  const double* place = run->jet().y.data();
  const JetState then = run->hand_out_jet();
  EXPECT_EQ(then.y.data(), place);
  EXPECT_NE(run->jet().y.data(), place);
  EXPECT_EQ(run->jet().y, then.y);
  EXPECT_EQ(run->jet().charge, then.charge);

  run->run_until(1e-3), other->run_until(1e-3);
  EXPECT_EQ(run->jet().y, other->jet().y); // nothing has changed for the run
  EXPECT_NE(run->jet().y, then.y);
}

} // namespace
} // namespace ehdjet
