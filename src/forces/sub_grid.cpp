#include "ehdjet/forces/sub_grid.hpp"

#include <gsl/gsl_sf_bessel.h>
#include <gsl/gsl_sf_zeta.h>

#include <array>
#include <cmath>
#include <numbers>

namespace ehdjet {
namespace {

/// b_m zeta(2m + 1), m = 1, 2, ...: b_m = b_(m-1) (1/2 - m)/m, b_0 = 1. At eta = 1/2 the terms that are
/// left out are below 1e-17.
constexpr std::size_t terms = 28;
const std::array<double, terms>& coefficients() {
  static const std::array<double, terms> values = [] {
    std::array<double, terms> c{};
    double b = 1;
    for (std::size_t i = 0; i < terms; ++i) {
      const auto m = static_cast<double>(i + 1);
      b *= (0.5 - m) / m;
      c[i] = b * gsl_sf_zeta_int(static_cast<int>(2 * i + 3));
    }
    return c;
  }();
  return values;
}

} // namespace

SubGrid sub_grid_of_points(double eta) {
  return {.d = std::log(2 / eta) - std::numbers::egamma, .e = -1, .f = 0};
}

SubGrid sub_grid_of_softened(double eta) {
  if (eta <= 0.5) {
    SubGrid s = sub_grid_of_points(eta);
    const double square = eta * eta;
    double power = 1, m = 0;
    for (const double c : coefficients()) {
      power *= square, ++m;
      const double term = c * power;
      s.d -= term, s.e -= 2 * m * term, s.f -= 4 * m * m * term;
      if (std::abs(4 * m * m * term) < 1e-17) break;
    }
    return s;
  }
  using std::numbers::pi;
  SubGrid s{.d = 1 / (2 * eta), .e = -1 / (2 * eta), .f = 1 / (2 * eta)};
  for (double k = 1;; ++k) {
    const double x = 2 * pi * k * eta;
    if (!(x <= 40)) return s; // K0(40) = 8e-19; also ends a state that is not a number
    const double k0 = gsl_sf_bessel_K0(x), k1 = gsl_sf_bessel_K1(x);
    s.d -= 2 * k0, s.e += 2 * x * k1, s.f -= 2 * x * x * k0;
  }
}

} // namespace ehdjet
