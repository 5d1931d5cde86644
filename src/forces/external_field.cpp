#include "ehdjet/forces/external_field.hpp"

namespace ehdjet {

void ExternalField::add_force(const Stage& stage, Vec3View force) {
  const double *q = stage.charge.data(), e = strength_;
  double* fx = force.x.data();
  const std::size_t n = force.size();
#pragma omp simd
  for (std::size_t k = 0; k < n; ++k) fx[k] += q[k] * e;
}

} // namespace ehdjet
