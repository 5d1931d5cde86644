#include <gtest/gtest.h>

#include "support/case_one.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

// The reference is right to 2e-8 cm, 1e-5 cm/s and 3e-3 dyn/cm2.
TEST(CaseOne, every_bead_is_where_the_reference_has_it_up_to_5_ms) {
  auto simulation = build_simulation(case_one("dormand-prince", 1e-9));
  for (const double ms : {1.0, 2.0, 5.0}) {
    simulation->run_until(ms * 1e-3);
    const Deviation d = deviation(simulation->jet(), state_at(ms));
    EXPECT_LE(d.position, 1e-7 * cm) << ms;
    EXPECT_LE(d.velocity, 1e-4 * cm) << ms;
    EXPECT_LE(d.stress, 1e-2 * dyn_cm2) << ms;
  }
}

} // namespace
} // namespace ehdjet
