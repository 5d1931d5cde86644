#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr std::size_t free_beads = 10;

/// Mode j of a bar that is held at bead 0: bead k moves as sin(k (2j-1) pi/21).
double shape(int mode, std::size_t k) {
  return std::sin(static_cast<double>(k) * (2 * mode - 1) * std::numbers::pi / 21);
}

/// The bar at rest but for a small velocity in one mode, along no axis.
Scene bar(int mode, const Vec3& direction) {
  Scene s = chain_scene(FixedEnds::first);
  const double speed = 1e-7 * pvp::link_length * 2e3; // strains stay of order 1e-7
  for (std::size_t k = 0; k <= free_beads; ++k) {
    Bead b = pvp_bead(static_cast<double>(k) * pvp::link_length * direction,
                      speed * shape(mode, k) * direction);
    b.charge = 0;
    add_bead(s, b);
  }
  s.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  integrate_with_fixed_steps(s, "rk4", 2e-7);
  return s;
}

struct Published {
  int mode;
  double imaginary;
};

// m w' = -omega^2 s, s' = w - s/tau: amplitudes that obey z1 + z2 = 2 e^(-h/2tau) cos(h Im s) and
// z1 z2 = e^(-h/tau) between samples h apart, from which the rate is fitted.
TEST(MaxwellBar, rings_in_its_eigenmodes_at_the_rates_of_the_dispersion_relation) {
  constexpr double h = 2e-5;
  for (const auto& [mode, imaginary] :
       {Published{1, 1328.38832366}, {2, 5285.57153987}, {10, 24103.33774702}}) {
    const Vec3 direction(1. / 3, 2. / 3, -2. / 3);
    std::vector<double> w; // amplitude of the mode's velocity
    auto simulation = build_simulation(bar(mode, direction));
    simulation->add(std::make_unique<Watch>(h, [&, number = mode](const JetSnapshot& s) {
      double amplitude = 0;
      for (std::size_t k = 1; k <= free_beads; ++k)
        amplitude += s.columns.velocity()[k].dot(direction) * shape(number, k);
      w.push_back(amplitude);
    }));
    simulation->run_until(1e-3);
    // Least squares for w_(i+1) = p w_i - q w_(i-1)
    double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
    for (std::size_t i = 1; i + 1 < w.size(); ++i) {
      const double a = w[i], b = -w[i - 1], c = w[i + 1];
      aa += a * a, ab += a * b, bb += b * b, ac += a * c, bc += b * c;
    }
    const double determinant = aa * bb - ab * ab;
    const double p = (ac * bb - bc * ab) / determinant,
                 q = (aa * bc - ab * ac) / determinant;
    const std::complex<double> z = p / 2 + std::sqrt(std::complex<double>(p * p / 4 - q));
    const std::complex<double> s = std::log(z) / h;
    EXPECT_NEAR(s.real(), -1250, 1e-6 * imaginary) << mode;
    EXPECT_NEAR(std::abs(s.imag()) / imaginary, 1, 1e-6) << mode;
  }
}

TEST(MaxwellBar, does_not_leave_its_mode_nor_its_line) {
  const Vec3 direction(1. / 3, 2. / 3, -2. / 3);
  const auto simulation = run(bar(2, direction), 3e-4);
  const auto c = simulation->jet().columns();
  const double amplitude = c.velocity()[1].dot(direction) / shape(2, 1);
  // Strains are 1e-7; positions are rounded to 1e-16 of 2 mm, 1e-8 of a displacement.
  for (std::size_t k = 1; k <= free_beads; ++k)
    EXPECT_LE((c.velocity()[k] - amplitude * shape(2, k) * direction).norm(),
              1e-5 * std::abs(amplitude))
        << k;
}

} // namespace
} // namespace ehdjet
