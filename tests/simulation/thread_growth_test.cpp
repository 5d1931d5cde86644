#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/forces/coulomb_force.hpp"
#include "ehdjet/forces/near_field.hpp"
#include "ehdjet/forces/softened_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "support/chain.hpp"
#include "support/scenes.hpp"

/// Bending waves of a long charged chain without surface tension: how fast they grow.
namespace ehdjet {
namespace {

using namespace test;
using std::numbers::pi;

struct Thread {
  double radius = 0, line_charge = 0; // [m], [C/m]
};
const Thread thin{7.906e-4 * cm, 0.0863938 * statC / cm};
const Thread thick{5e-3 * cm, 3.4558 * statC / cm};

enum class Near { point, fixed, free_surface, softened };

/// The growth rate of a wave, from the forces on the middle wavelength of a long chain [1/s].
double growth_rate(const Thread& thread, double wavelength, double length, Near near,
                   const std::string& solver = "direct") {
  const auto per_wave = static_cast<std::size_t>(std::lround(wavelength / length));
  constexpr std::size_t waves = 81;
  const std::size_t n = waves * per_wave + 1;
  const double k = 2 * pi / wavelength, amplitude = 1e-4 * wavelength;
  const double section = pi * thread.radius * thread.radius;
  Chain chain(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = length * (static_cast<double>(i) - static_cast<double>(n / 2));
    chain.place(i, {x, amplitude * std::cos(k * x), 0});
    chain.volume[i] = section * length, chain.mass[i] = pvp::density * section * length;
    chain.charge[i] = thread.line_charge * length;
  }
  CoulombForce coulomb(make_coulomb_solver({.solver = solver, .tolerance = 1e-9}));
  auto force = chain.force(coulomb);
  const auto add = [&](ForceTerm& term) {
    const auto more = chain.force(term);
    for (std::size_t i = 0; i < n; ++i) force[i] += more[i];
  };
  if (near != Near::point) {
    NearField term(
        {.kind = near == Near::fixed ? NearFieldKind::fixed : NearFieldKind::free_surface,
         .softened = near == Near::softened});
    add(term);
  }
  if (near == Near::softened) {
    SoftenedPairs pairs({});
    add(pairs);
  }
  double response = 0, square = 0;
  const std::size_t begin = (waves / 2) * per_wave;
  for (std::size_t i = begin; i < begin + per_wave; ++i) {
    const double y = chain.columns().position().y[i];
    response += force[i].y() * y, square += y * y;
  }
  return std::sqrt(response / square / chain.mass[0]);
}

struct Row {
  double length, point, fixed;
};

// Computed independently for an infinite chain.
TEST(BendingOfAThread, grows_as_published_with_points_and_with_a_fixed_radius) {
  for (const Row& row : {Row{0.8, 119.72, 270.86}, Row{0.4, 148.28, 282.41},
                         Row{0.2, 172.37, 285.04}, Row{0.1, 193.53, 285.61}}) {
    const double l = row.length * cm;
    EXPECT_NEAR(growth_rate(thin, 4 * cm, l, Near::point) / row.point, 1, 1e-4) << l;
    EXPECT_NEAR(growth_rate(thin, 4 * cm, l, Near::fixed) / row.fixed, 1, 1e-4) << l;
  }
  for (const Row& row : {Row{0.8, 757.2, 1487.6}, Row{0.2, 1090.2, 1559.5}}) {
    const double l = row.length * cm;
    EXPECT_NEAR(growth_rate(thick, 4 * cm, l, Near::point) / row.point, 1, 2e-4) << l;
    EXPECT_NEAR(growth_rate(thick, 4 * cm, l, Near::fixed) / row.fixed, 1, 2e-4) << l;
  }
}

/// Bending of a conducting liquid cylinder, long waves: s^2 = k_C lambda^2/(rho pi a^4) x K0(x)/K1(x).
double of_cylinder(const Thread& thread, double wavelength) {
  const double a = thread.radius, x = 2 * pi * a / wavelength;
  const double strength = constants::coulomb * thread.line_charge * thread.line_charge
                          / (pvp::density * pi * std::pow(a, 4));
  return std::sqrt(strength * x * std::cyl_bessel_k(0, x) / std::cyl_bessel_k(1, x));
}

TEST(BendingOfAThread, with_a_free_surface_grows_like_a_liquid_cylinder_with_every_solver) {
  for (const std::string solver : {"direct", "treecode", "fmm"})
    for (const double wavelength : {1 * cm, 2 * cm, 4 * cm, 8 * cm, 16 * cm}) {
      const double exact = of_cylinder(thin, wavelength);
      const auto error = [&](double per_wave) {
        return growth_rate(thin, wavelength, wavelength / per_wave, Near::free_surface,
                           solver)
                   / exact
               - 1;
      };
      const double coarse = error(10), fine = error(20);
      EXPECT_LE(std::abs(fine), 3.1e-3) << solver << wavelength;
      EXPECT_GE(coarse / fine, 3.5) << solver << wavelength; // second order
    }
}

// Also where links are not longer than the thread is thick.
TEST(BendingOfAThread, with_softened_pairs_grows_like_a_liquid_cylinder) {
  const double wavelength = 4 * cm;
  const double exact = of_cylinder(thick, wavelength);
  const auto error = [&](double per_wave) {
    return growth_rate(thick, wavelength, wavelength / per_wave, Near::softened) / exact
           - 1;
  };
  EXPECT_LE(std::abs(error(20)), 3e-3);
  EXPECT_LE(std::abs(error(100)), 4e-4);
  EXPECT_LE(std::abs(error(400)), 4e-4); // l = 2 a
}

} // namespace
} // namespace ehdjet
