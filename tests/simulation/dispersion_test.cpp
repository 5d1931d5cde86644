#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/bent_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;

TEST(Dispersion, the_static_force_on_a_bent_chain_is_the_lattice_sum) {
  constexpr std::size_t half = 100;
  const double l = pvp::link_length, eps = 1e-6 * l;
  for (const double w : wavelengths) {
    Scene scene = chain_scene();
    for (std::size_t k = 0; k <= 2 * half; ++k) {
      const double j = static_cast<double>(k) - static_cast<double>(half);
      add_bead(scene, pvp_bead({j * l, eps * std::cos(kappa_of(w) * j), 0}));
    }
    scene.config.coulomb = CoulombConfig{};
    const auto dynamics = build_dynamics(scene);
    JetState jet = initial_jet(scene);
    dynamics->bind(jet);
    std::vector<double> rate(jet.y.size());
    dynamics->evaluate(0, jet.y, rate);
    const double force = pvp::mass * rate[4 * jet.beads() + half];
    const double exact = 2 * constants::coulomb * pvp::charge * pvp::charge / (l * l * l)
                         * eps * coulomb_sum(kappa_of(w), static_cast<int>(half));
    EXPECT_NEAR(force / exact, 1, 1e-9) << w;
  }
}

TEST(Dispersion, growth_rates_are_the_published_ones) {
  const std::array<double, 5> published{43508.9019, 34419.6766, 18724.4796, 10887.5181,
                                        5051.28253};
  for (std::size_t i = 0; i < published.size(); ++i)
    EXPECT_NEAR(growth_rate(wavelengths[i]) / published[i], 1, 1e-8) << wavelengths[i];
}

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
