#include "ehdjet/coulomb/energy.hpp"

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"
#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <vector>

namespace ehdjet {

double coulomb_energy(ConstVec3View r, std::span<const double> q) {
  EHDJET_EXPECTS(r.size() == q.size());
  const std::size_t n = q.size();
  std::vector<double> potential(n); // of the charges before each one, without the constant
#pragma omp parallel for schedule(dynamic, 64) if (n > 512)
  for (std::size_t i = 0; i < n; ++i) potential[i] = potential_sum(r[i], r, q, 0, i);
  CompensatedSum energy;
  for (std::size_t i = 0; i < n; ++i) energy += q[i] * potential[i];
  return constants::coulomb * energy;
}

double CoulombSolver::energy(ConstVec3View r, std::span<const double> q) const {
  return coulomb_energy(r, q);
}

} // namespace ehdjet
