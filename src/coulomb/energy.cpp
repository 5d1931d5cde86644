#include "ehdjet/coulomb/energy.hpp"

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/solver.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace ehdjet {

double coulomb_energy(ConstVec3View r, std::span<const double> q) {
  EHDJET_EXPECTS(r.size() == q.size());
  const std::size_t n = q.size();
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data(), *charge = q.data();
  std::vector<double> potential(n); // of the charges before each one, without the constant
#pragma omp parallel for schedule(dynamic, 64) if (n > 512)
  for (std::size_t i = 0; i < n; ++i) {
    const double xi = x[i], yi = y[i], zi = z[i];
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = xi - x[j], dy = yi - y[j], dz = zi - z[j];
      const double square = dx * dx + dy * dy + dz * dz;
      sum += square > 0 ? charge[j] / std::sqrt(square) : 0.0;
    }
    potential[i] = sum;
  }
  CompensatedSum energy;
  for (std::size_t i = 0; i < n; ++i) energy += q[i] * potential[i];
  return constants::coulomb * energy;
}

double CoulombSolver::energy(ConstVec3View r, std::span<const double> q) {
  return coulomb_energy(r, q);
}

} // namespace ehdjet
