#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

// A computation apart from this program has 18.7 m, and the plate is reached after 60 ms; it puts the
// whole drag of a link on its lower bead. With that, the jet here is 18.0 m long. With half of it on each end,
// the leading bead, which has no link below it, feels less and reaches the plate earlier.
TEST(JetInAir, of_the_pvp_fluid_is_seventeen_metres_long_after_60_ms) {
  Scene scene = case_one("two-rate", 1e-7);
  scene.config.air = AirConfig{};
  const JetState jet = run(scene, 60e-3)->jet();
  double path = 0;
  for (std::size_t k = jet.first(); k < jet.beads(); ++k) path += link_length(jet, k);
  EXPECT_NEAR(path, 18.7, 0.08 * 18.7);
  ASSERT_FALSE(jet.landed.empty());
  EXPECT_NEAR(jet.landed.back().time, 46.19e-3,
              1e-4); // the leading bead, still in the chain
}

} // namespace
} // namespace ehdjet
