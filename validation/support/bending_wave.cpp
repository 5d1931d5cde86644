#include "bending_wave.hpp"

#include "ehdjet/core/constants.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace ehdjet::validation {
namespace {

using namespace test;

double rate() { // Gamma [1/s]
  const double l = pvp::link_length;
  return std::sqrt(constants::coulomb * pvp::charge * pvp::charge
                   / (pvp::mass * l * l * l));
}

} // namespace

BendingWave::BendingWave(std::vector<double> wavelengths)
    : wavelengths_(std::move(wavelengths))
    , scene_(chain_scene()) {
  for (std::size_t k = 0; k < beads; ++k) {
    double y = 0;
    for (const double n : wavelengths_) y += amplitude * pvp::link_length * cosine(n, k);
    add_bead(scene_, pvp_bead({static_cast<double>(k) * pvp::link_length, y, 0}));
  }
  scene_.config.coulomb = CoulombConfig{};
  scene_.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  scene_.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension};
}

double BendingWave::cosine(double wavelength, std::size_t bead) const {
  const double from_middle = static_cast<double>(bead) - static_cast<double>(beads / 2);
  return std::cos(2 * std::numbers::pi / wavelength * from_middle);
}

double BendingWave::link_length() const {
  return pvp::link_length;
}

double BendingWave::time(double gammas) const {
  return gammas / rate();
}

double BendingWave::theory(double wavelength) const {
  const double kappa = 2 * std::numbers::pi / wavelength, l = pvp::link_length;
  double c = 0;
  for (double p = 100'000; p >= 1; --p) c += (1 - std::cos(p * kappa)) / (p * p * p);
  const double tension =
      std::numbers::pi * pvp::radius * pvp::radius * pvp::surface_tension / l;
  const double sine = std::sin(kappa / 2);
  return std::sqrt(2 * rate() * rate() * c - 4 / (pvp::mass * l) * tension * sine * sine);
}

std::vector<double> BendingWave::growth(const JetState& jet) const {
  // Whole waves, so that the cosines are orthogonal and none leaks into another.
  constexpr std::size_t rows = 200, first = beads / 2 - rows / 2;
  const auto n = static_cast<Eigen::Index>(rows),
             waves = static_cast<Eigen::Index>(wavelengths_.size());
  Eigen::MatrixXd cosines(n, waves);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t bead = first + static_cast<std::size_t>(i);
    y(i) = jet.columns().position().y[bead];
    for (Eigen::Index w = 0; w < waves; ++w)
      cosines(i, w) = cosine(wavelengths_[static_cast<std::size_t>(w)], bead);
  }
  const Eigen::VectorXd fit = cosines.colPivHouseholderQr().solve(y);
  std::vector<double> growth;
  for (const double fitted : fit) growth.push_back(fitted / (amplitude * pvp::link_length));
  return growth;
}

double BendingWave::growth_rate(const JetState& jet, double wavelength) const {
  const auto w = std::ranges::find(wavelengths_, wavelength);
  const auto at = static_cast<std::size_t>(w - wavelengths_.begin());
  return std::acosh(growth(jet).at(at)) / jet.time;
}

} // namespace ehdjet::validation
