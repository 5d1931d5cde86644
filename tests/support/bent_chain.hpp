#pragma once

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet::test {

// A straight chain of N beads at rest, spacing l, displaced by cosines of all these wavelengths
// (in beads) at
// once: each grows as cosh(s t) with s^2 = 2 Gamma^2 C(kappa) - (4/(m l)) T_st sin^2(kappa/2).
inline constexpr std::array<double, 5> wavelengths{2, 4, 10, 20, 50};
inline constexpr std::size_t centre = 400, beads = 2 * centre + 1;
inline constexpr double amplitude = 1e-7 * pvp::link_length;

inline double gamma_rate() {
  return std::sqrt(constants::coulomb * pvp::charge * pvp::charge
                   / (pvp::mass * std::pow(pvp::link_length, 3)));
}

/// C(kappa) = sum over p of (1 - cos(p kappa))/p^3, up to p = last.
inline double coulomb_sum(double kappa, int last) {
  double sum = 0;
  for (int p = last; p >= 1; --p) // small ones first
    sum += (1 - std::cos(p * kappa)) / (static_cast<double>(p) * p * p);
  return sum;
}
inline double kappa_of(double wavelength) {
  return 2 * std::numbers::pi / wavelength;
}
inline double growth_rate(double wavelength) {
  const double kappa = kappa_of(wavelength), gamma = gamma_rate();
  const double tension = std::numbers::pi * pvp::radius * pvp::radius * pvp::surface_tension
                         / pvp::link_length;
  return std::sqrt(2 * gamma * gamma * coulomb_sum(kappa, 100'000)
                   - 4 / (pvp::mass * pvp::link_length) * tension
                         * std::pow(std::sin(kappa / 2), 2));
}

/// Axes of the chain: along it, in the plane in which it is bent, out of that plane.
using Axes = std::array<Vec3, 3>;
inline const Axes straight{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
/// Along no axis: the errors of expansions have no symmetry.
inline const Axes skew{Vec3(1, 2, -2) / 3, Vec3(2, 1, 2) / 3, Vec3(2, -2, -1) / 3};

inline Scene bent_chain(const Axes& axes, const std::string& solver, double tolerance,
                        double stress = 0) {
  Scene scene = chain_scene();
  for (std::size_t k = 0; k < beads; ++k) {
    const double j = static_cast<double>(k) - static_cast<double>(centre);
    double y = 0;
    for (const double w : wavelengths) y += amplitude * std::cos(kappa_of(w) * j);
    Bead bead = pvp_bead(j * pvp::link_length * axes[0] + y * axes[1]);
    bead.declared = {stress};
    add_bead(scene, bead);
  }
  scene.config.coulomb = CoulombConfig{.solver = solver, .tolerance = tolerance};
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  scene.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension};
  integrate(scene, "dop853", 1e-9);
  // What grows is tiny: its error is measured against a millionth of a link and of its speed.
  scene.config.integrator.position_scale = 1e-2 * amplitude / 1e-9;
  scene.config.integrator.velocity_scale = 1e-2 * amplitude / 1e-9 * gamma_rate();
  return scene;
}

/// Amplitudes of the wavelengths in the middle 200 beads over those at the start, by least squares.
inline std::array<double, 5> grown(std::span<const double> y) {
  constexpr std::size_t n = wavelengths.size();
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> right = Eigen::Matrix<double, 5, 1>::Zero();
  for (std::size_t k = centre - 100; k < centre + 100; ++k) {
    Eigen::Matrix<double, 5, 1> row;
    for (std::size_t i = 0; i < n; ++i)
      row[static_cast<int>(i)] =
          std::cos(kappa_of(wavelengths[i])
                   * (static_cast<double>(k) - static_cast<double>(centre)));
    normal += row * row.transpose();
    right += y[k] * row;
  }
  const Eigen::Matrix<double, 5, 1> fit = normal.ldlt().solve(right) / amplitude;
  std::array<double, 5> out{};
  for (std::size_t i = 0; i < n; ++i) out[i] = fit[static_cast<int>(i)];
  return out;
}

inline std::vector<double> along(const Vec3& axis, ConstVec3View v) {
  std::vector<double> component(v.size());
  for (std::size_t k = 0; k < v.size(); ++k) component[k] = axis.dot(v[k]);
  return component;
}
inline double largest(const std::vector<double>& v) {
  double size = 0;
  for (const double a : v) size = std::max(size, std::abs(a));
  return size;
}

} // namespace ehdjet::test
