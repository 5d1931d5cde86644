#include <gtest/gtest.h>

#include "support/bookkeeping.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

// A collector 8 mm away: beads land within the first milliseconds.
TEST(Bookkeeping, mass_charge_and_volume_of_chain_and_deposit_are_what_was_inserted) {
  for (const auto placement : {EventPlacement::located, EventPlacement::step_end}) {
    Scene scene = case_one("dormand-prince", 1e-5);
    scene.config.collector->distance = 8e-3;
    scene.config.field =
        FieldConfig{.potential = {}, .strength = pvp::potential / pvp::distance};
    scene.config.integrator.events = placement;
    expect_balance_throughout(scene, 10e-3, 100);
  }
}

} // namespace
} // namespace ehdjet
