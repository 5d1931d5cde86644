#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "support/bent_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;

// With a tension that relaxes: Bessel functions of an order near 30 (validated against an
// independent program to 4e-4 and 1.3e-3, the effect of the ends).
TEST(Dispersion, a_relaxing_tension_slows_or_stops_the_growth) {
  struct Case {
    double stress, tolerance;
    std::array<double, 5> amplitude;
  };
  const Case cases[] = {
      {1e5 * dyn_cm2, 5e-4, {143.2073, 69.72879, 10.07969, 3.166494, 1.404153}},
      {1e6 * dyn_cm2, 1.5e-3, {-0.9278797, 0.2331342, -0.3115375, -0.6404421, 0.7461455}}};
  for (const Case& c : cases) {
    const auto simulation =
        run(bent_chain(straight, "direct", 0, c.stress), 4 / gamma_rate());
    const auto a = grown(simulation->jet().columns().position().y);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], c.amplitude[i], c.tolerance * std::max(1.0, c.amplitude[i]))
          << c.stress << ' ' << wavelengths[i];
  }
}

} // namespace
} // namespace ehdjet
