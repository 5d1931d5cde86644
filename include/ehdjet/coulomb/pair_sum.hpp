#pragma once

#include "ehdjet/core/columns.hpp"

#include <cmath>
#include <cstddef>
#include <span>

namespace ehdjet {

/// Potential and field of point charges at one place, without the factor k_C:
///
///     potential = sum_j q_j/d_j,  field = sum_j q_j d_j/d_j^3,  magnitude = sum_j |q_j|/d_j^2
///
/// Here d_j is the vector from charge j to the place. Charges at the place itself are skipped.
template <class Real>
struct PairSum {
  Real potential = 0, x = 0, y = 0, z = 0, magnitude = 0;

  [[nodiscard]] Vec3 field() const {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }
  PairSum& operator+=(const PairSum& o) {
    potential += o.potential, magnitude += o.magnitude;
    x += o.x, y += o.y, z += o.z;
    return *this;
  }
};

/// The sum over the charges [begin, end) in the arithmetic of `Real`.
///
/// shapes : r, q (n)                  units : [m], [C] -> [C/m], [C/m^2]
template <class Real = double>
PairSum<Real> pair_sum(const Vec3& at, ConstVec3View r, std::span<const double> q,
                       std::size_t begin, std::size_t end) {
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data(), *charge = q.data();
  const Real x0 = at.x(), y0 = at.y(), z0 = at.z();
  Real potential = 0, ex = 0, ey = 0, ez = 0, magnitude = 0;
#pragma omp simd reduction(+ : potential, ex, ey, ez, magnitude)
  for (std::size_t j = begin; j < end; ++j) {
    const Real dx = x0 - x[j], dy = y0 - y[j], dz = z0 - z[j];
    const Real square = dx * dx + dy * dy + dz * dz;
    const Real v = square > 0 ? charge[j] / std::sqrt(square) : Real{0};
    const Real e = square > 0 ? v / square : Real{0};
    potential += v, magnitude += std::abs(e) * std::sqrt(square);
    ex += e * dx, ey += e * dy, ez += e * dz;
  }
  return {potential, ex, ey, ez, magnitude};
}

/// The sum over all charges except the charge `skipped`.
template <class Real = double>
PairSum<Real> pair_sum(const Vec3& at, ConstVec3View r, std::span<const double> q,
                       std::size_t skipped) {
  PairSum<Real> sum = pair_sum<Real>(at, r, q, 0, skipped);
  return sum += pair_sum<Real>(at, r, q, skipped + 1, q.size());
}

/// Only the potential of the charges [begin, end).
inline double potential_sum(const Vec3& at, ConstVec3View r, std::span<const double> q,
                            std::size_t begin, std::size_t end) {
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data(), *charge = q.data();
  const double x0 = at.x(), y0 = at.y(), z0 = at.z();
  double potential = 0;
#pragma omp simd reduction(+ : potential)
  for (std::size_t j = begin; j < end; ++j) {
    const double dx = x0 - x[j], dy = y0 - y[j], dz = z0 - z[j];
    const double square = dx * dx + dy * dy + dz * dz;
    potential += square > 0 ? charge[j] / std::sqrt(square) : 0.0;
  }
  return potential;
}

} // namespace ehdjet
