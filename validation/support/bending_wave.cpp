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

BendingWave::BendingWave(Shape shape)
    : shape_(std::move(shape))
    , scene_(chain_scene()) {
  for (std::size_t k = 0; k < shape_.beads; ++k) {
    double y = 0;
    for (const double n : shape_.wavelengths)
      y += shape_.amplitude * pvp::link_length * cosine(n, k);
    add_bead(scene_, pvp_bead({static_cast<double>(k) * pvp::link_length, y, 0}));
  }
  scene_.config.coulomb = CoulombConfig{};
  scene_.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  scene_.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension};
}

double BendingWave::cosine(double wavelength, std::size_t bead) const {
  const double from_middle =
      static_cast<double>(bead) - static_cast<double>(shape_.beads / 2);
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
  const std::size_t rows = std::min<std::size_t>(201, shape_.beads),
                    first = shape_.beads / 2 - rows / 2;
  const auto n = static_cast<Eigen::Index>(rows),
             waves = static_cast<Eigen::Index>(shape_.wavelengths.size());
  Eigen::MatrixXd cosines(n, waves);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t bead = first + static_cast<std::size_t>(i);
    y(i) = jet.columns().position().y[bead];
    for (Eigen::Index w = 0; w < waves; ++w)
      cosines(i, w) = cosine(shape_.wavelengths[static_cast<std::size_t>(w)], bead);
  }
  const Eigen::VectorXd fit = cosines.colPivHouseholderQr().solve(y);
  std::vector<double> growth;
  for (const double amplitude : fit)
    growth.push_back(amplitude / (shape_.amplitude * pvp::link_length));
  return growth;
}

double BendingWave::growth_rate(const JetState& jet, double wavelength) const {
  const auto w = std::ranges::find(shape_.wavelengths, wavelength);
  const auto at = static_cast<std::size_t>(w - shape_.wavelengths.begin());
  return std::acosh(growth(jet).at(at)) / jet.time;
}

} // namespace ehdjet::validation
