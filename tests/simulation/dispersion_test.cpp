#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/bent_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;

// Amplitudes that an independent program found for this very chain, at Gamma t = 2 and 4.
struct Published {
  double gamma_t;
  std::array<double, 5> amplitude;
};
const Published simulated[] = {{2, {29.83864, 12.71688, 2.991106, 1.570673, 1.114782}},
                               {4, {1779.132, 322.3626, 16.89159, 3.933811, 1.485436}}};

TEST(Dispersion, bent_chains_grow_at_the_rates_of_theory_with_every_solver) {
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    const bool exact = solver == "direct";
    constexpr double tolerance = 1e-8;
    const Axes& axes = exact ? straight : skew;
    const auto simulation = build_simulation(bent_chain(axes, solver, tolerance));
    for (const Published& then : simulated) {
      const double t = then.gamma_t / gamma_rate();
      simulation->run_until(t);
      const auto r = simulation->jet().columns().position();
      const auto a = grown(along(axes[1], r));
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double s = std::acosh(a[i]) / t;
        EXPECT_NEAR(s / growth_rate(wavelengths[i]), 1, 1e-3) << solver << wavelengths[i];
        EXPECT_NEAR(a[i] / std::cosh(growth_rate(wavelengths[i]) * t), 1, 1e-3)
            << solver << wavelengths[i];
        const double agreement = exact ? 1e-6 : 1e-4; // with the other program
        EXPECT_NEAR(a[i] / then.amplitude[i], 1, agreement) << solver << wavelengths[i];
      }
      // Nothing pushes out of the plane but what the solver gets wrong, and that grows as all
      // else does.
      const double out = largest(along(axes[2], r));
      if (exact) {
        EXPECT_EQ(out, 0);
      } else {
        EXPECT_LE(out, tolerance * a[0] * pvp::link_length) << solver;
        EXPECT_GT(out, 0) << solver;
      }
    }
  }
}

} // namespace
} // namespace ehdjet
