#include "ehdjet/integrators/stability_region.hpp"

#include "ehdjet/core/error.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace ehdjet {

std::complex<double> amplification(const ButcherTableau& method, std::complex<double> z) {
  std::array<std::complex<double>, 16> k;
  EHDJET_EXPECTS(method.stages.size() <= k.size());
  std::complex<double> end = 1;
  for (std::size_t i = 0; i < method.stages.size(); ++i) {
    std::complex<double> y = 1;
    const auto& a = method.stages[i].a;
    for (std::size_t j = 0; j < a.size(); ++j) y += a[j] * k[j];
    k[i] = z * y;
    end += method.b[i] * k[i];
  }
  return end;
}

double longest_stable_step(const ButcherTableau& method, std::complex<double> s) {
  EHDJET_EXPECTS(s.real() <= 0);
  if (s == 0.0) return std::numeric_limits<double>::infinity();
  const std::complex<double> direction = s / std::abs(s);
  const auto stable = [&](double r) {
    const double round_off = 1e-12; // near 0 on the imaginary axis |R| = 1 to higher order
    return std::abs(amplification(method, r * direction)) <= 1 + round_off;
  };
  constexpr double stride = 0.05,
                   farthest = 100; // no explicit method of s stages reaches 2 s^2
  double inside = 0, outside = stride;
  while (outside < farthest && stable(outside)) inside = outside, outside += stride;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (stable(middle) ? inside : outside) = middle;
  }
  return inside / std::abs(s);
}

} // namespace ehdjet
