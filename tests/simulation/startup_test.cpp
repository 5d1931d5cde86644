#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// A bead on one viscoelastic link that hangs from a fixed charged bead, in the field: the start
/// of a jet in one dimension. Fluid and geometry of JETSPIN's first example.
struct StartUp {
  static constexpr double density = 0.818912288 * gram / cm3;
  static constexpr double charge_density = 3761.26389 * statC / cm3;
  static constexpr double radius = 0.015 * cm, length = 0.319 * cm;
  static constexpr double viscosity = 100 * poise, modulus = 1e4 * dyn_cm2;
  static constexpr double tau = viscosity / modulus;
  static constexpr double volume = std::numbers::pi * radius * radius * length;
  static constexpr double mass = density * volume, charge = charge_density * volume;

  /// Groups Q = k q^2 tau^2/(m l^3), V = q E tau^2/(m l), F = pi a^2 G tau^2/(m l).
  explicit StartUp(double field_strength) {
    scene = chain_scene(FixedEnds::first);
    Bead bead{.volume = volume, .mass = mass, .charge = charge};
    add_bead(scene, bead);
    bead.position = {length, 0, 0};
    add_bead(scene, bead);
    scene.config.coulomb = CoulombConfig{};
    scene.config.field = FieldConfig{.potential = {}, .strength = field_strength};
    scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
  }
  Scene scene;
};

constexpr double printed_field = 277.8141 * statV / (200 * cm);

TEST(StartUp, the_groups_of_the_published_example_are_twelve_two_and_twelve) {
  using S = StartUp;
  const double unit = S::tau * S::tau / (S::mass * S::length);
  const double kqq = constants::coulomb * S::charge * S::charge;
  EXPECT_NEAR(kqq / (S::length * S::length) * unit, 12, 1e-7);
  EXPECT_NEAR(S::charge * printed_field * unit, 2.00000012, 1e-7);
  EXPECT_NEAR(S::volume / S::length * S::modulus * unit, 12, 1e-7);
}

// JETSPIN's own log, 10 digits. Its time is a naive sum of 10^7 steps, which by then is off by some
// 1e-9 tau: two units of the last digit of the length.
TEST(StartUp, reproduces_the_published_run) {
  for (const bool fixed_steps : {false, true}) {
    StartUp start(printed_field);
    if (fixed_steps) integrate_with_fixed_steps(start.scene, "rk4", 1e-3 * StartUp::tau);
    const auto simulation = run(start.scene, 10 * StartUp::tau);
    const auto c = simulation->jet().columns();
    EXPECT_NEAR(c.position()[1].x() / StartUp::length, 95.85942443, 2e-8);
    EXPECT_NEAR(c.velocity()[1].x() * StartUp::tau / StartUp::length, 18.65420366, 1e-8);
    EXPECT_NEAR(stress_of(c)[1] / StartUp::modulus, 0.2155019712, 1e-10);
    EXPECT_EQ(c.position()[1].y(), 0);
    EXPECT_EQ(c.position()[1].z(), 0);
  }
}

struct Published {
  double t, length, speed, stress;
};

// l' = W, W' = V - F s/l + Q/l^2, s' = W/l - s with exactly Q = F = 12, V = 2; a Taylor series in
// 17 digits. The fluid's numbers are adjusted to give these groups.
TEST(StartUp, follows_the_dimensionless_equations) {
  const Published rows[] = {
      {0.1, 1.0680191162372168, 1.3228654170714441, 0.063613852579830251},
      {0.5, 2.1490677970229815, 3.3642054997284294, 0.61949316213805034},
      {1, 3.8919664687024537, 3.5457704342092002, 0.83257558930829347},
      {2, 7.6977834735913265, 4.213887149582704, 0.72004098214937558},
      {5, 26.988528675181162, 8.9940647681220398, 0.39381180402455708},
      {10, 95.859418578681402, 18.654202462964374, 0.21550197016876065},
  };
  constexpr double l = 3e-3, tau = 0.02, mass = 2e-6, modulus = 900;
  const double unit = mass * l / (tau * tau);
  Scene scene = chain_scene(FixedEnds::first);
  Bead bead{.volume = 12 * unit * l / modulus,
            .mass = mass,
            .charge = std::sqrt(12 * unit * l * l / constants::coulomb)};
  add_bead(scene, bead);
  bead.position = {l, 0, 0};
  add_bead(scene, bead);
  scene.config.coulomb = CoulombConfig{};
  scene.config.field = FieldConfig{.potential = {}, .strength = 2 * unit / bead.charge};
  scene.config.viscoelasticity = ViscoelasticityConfig{modulus, modulus * tau};
  integrate(scene, "dop853", 1e-13);
  for (const auto& [t, length, speed, stress] : rows) {
    const auto simulation = run(scene, t * tau);
    const auto c = simulation->jet().columns();
    EXPECT_NEAR(c.position()[1].x() / l / length, 1, 1e-12) << t;
    EXPECT_NEAR(c.velocity()[1].x() * tau / l / speed, 1, 1e-12) << t;
    EXPECT_NEAR(stress_of(c)[1] / modulus / stress, 1, 1e-12) << t;
  }
}

} // namespace
} // namespace ehdjet
