#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "support/scenes.hpp"

/// Runs that go on from checkpoints.
namespace ehdjet::test {

class KeepCheckpoints final : public Observer {
public:
  explicit KeepCheckpoints(std::vector<Checkpoint>& kept)
      : kept_(kept) {}
  void checkpoint(const Checkpoint& c) override { kept_.push_back(c); }

private:
  std::vector<Checkpoint>& kept_;
};

/// The end of a run from each of its checkpoints has the bits of the run itself.
inline void expect_same_bits_after_checkpoints(const Scene& scene, double interval,
                                               double end_time) {
  std::vector<Checkpoint> checkpoints;
  auto whole = build_simulation(scene);
  whole->make_checkpoints(interval);
  whole->add(std::make_unique<KeepCheckpoints>(checkpoints));
  whole->run_until(end_time);
  ASSERT_FALSE(checkpoints.empty());
  for (const Checkpoint& c : checkpoints) {
    auto rest = build_simulation(scene);
    rest->make_checkpoints(interval);
    rest->restore(c);
    rest->run_until(end_time);
    EXPECT_EQ(rest->jet().y, whole->jet().y) << c.at("jet.time")[0];
    EXPECT_EQ(rest->statistics().steps, whole->statistics().steps);
  }
}

} // namespace ehdjet::test
