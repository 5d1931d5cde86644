#pragma once

#include "ehdjet/core/constants.hpp"

#include <algorithm>
#include <cmath>

#include "coulomb/chains.hpp"

namespace ehdjet::test {

__extension__ typedef __float128 Quad; ///< 113 bits, exponent to 1e4932

/// One Newton step doubles the 64 bits of the long double root.
inline Quad root(Quad a) {
  const Quad s = std::sqrt(static_cast<long double>(a));
  return s == 0 ? s : (s + a / s) / 2;
}

/// The force on one bead by the formula of `CoulombSolver`, and sum_j |f_ij|, the scale of
/// its terms: against that, not against the net force, round-off must be measured.
struct ReferenceForce {
  Quad x = 0, y = 0, z = 0, pair_sum = 0;

  ReferenceForce(const Chain& c, std::size_t i) {
    for (std::size_t j = 0; j < c.size(); ++j) {
      const Quad dx = Quad(c.x[i]) - c.x[j], dy = Quad(c.y[i]) - c.y[j],
                 dz = Quad(c.z[i]) - c.z[j], r2 = dx * dx + dy * dy + dz * dz;
      if (r2 == 0) continue;
      const Quad f = constants::coulomb * Quad(c.q[i]) * c.q[j] / r2, over_r = f / root(r2);
      x += over_r * dx, y += over_r * dy, z += over_r * dz;
      pair_sum += f < 0 ? -f : f;
    }
  }

  /// |f - F| / sum_j |f_ij|; 0/0 is 0, and a NaN stays one.
  [[nodiscard]] double error_of(const Vec3& f) const {
    const Quad ex = x - f.x(), ey = y - f.y(), ez = z - f.z();
    const Quad e = root(ex * ex + ey * ey + ez * ez);
    return e == 0 ? 0 : static_cast<double>(e / pair_sum);
  }
};

/// Largest error over at most `samples` evenly spaced beads.
inline double worst_error(const Chain& c, const Force& force, std::size_t samples = 300) {
  double worst = 0;
  samples = std::min(samples, c.size());
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t i = k * c.size() / samples;
    const double error = ReferenceForce(c, i).error_of(force[i]);
    if (error > worst || std::isnan(error)) worst = error; // keeps a NaN
  }
  return worst;
}

} // namespace ehdjet::test
