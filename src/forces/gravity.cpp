#include "ehdjet/forces/gravity.hpp"

namespace ehdjet {

void Gravity::add_force(const Stage& stage, Vec3View force) {
  const double *m = stage.mass.data(), g = acceleration_;
  double* fx = force.x.data();
  const std::size_t n = force.size();
#pragma omp simd
  for (std::size_t k = 0; k < n; ++k) fx[k] += m[k] * g;
}

} // namespace ehdjet
