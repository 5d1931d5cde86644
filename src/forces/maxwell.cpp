#include "ehdjet/forces/maxwell.hpp"

#include "ehdjet/core/error.hpp"

#include "link_tension.hpp"

namespace ehdjet {

Maxwell::Maxwell(double elastic_modulus, double viscosity)
    : elastic_modulus_(elastic_modulus)
    , relaxation_rate_(elastic_modulus / viscosity) {
  EHDJET_EXPECTS(elastic_modulus > 0 && viscosity > 0);
}

void Maxwell::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *sigma = stage.columns.stress().data();
  tension_per_length_.assign(links.length.size(), 0.0);
  double* t = tension_per_length_.data();
#pragma omp simd
  for (std::size_t k = links.first; k <= links.last; ++k)
    t[k] = v[k] * sigma[k] / (l[k] * l[k]);
  add_link_tension(links, tension_per_length_, force);
}

void Maxwell::stress_rate(const Stage& stage, std::span<double> rate) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  const double *l = links.length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data(), *vx = v.x.data(), *vy = v.y.data(), *vz = v.z.data(),
               *sigma = stage.columns.stress().data();
  double* out = rate.data();
  const double g = elastic_modulus_, relaxation = relaxation_rate_;
  const auto link = [=](std::size_t k, std::size_t upstream) {
    const double stretching = (vx[k] - vx[upstream]) * dx[k]
                              + (vy[k] - vy[upstream]) * dy[k]
                              + (vz[k] - vz[upstream]) * dz[k];
    out[k] = g * stretching / (l[k] * l[k]) - relaxation * sigma[k];
  };
  for (std::size_t k = 0; k < links.first; ++k) out[k] = 0;
  link(links.first, 0);
#pragma omp simd
  for (std::size_t k = links.first + 1; k <= links.last; ++k) link(k, k - 1);

  // A landed bead keeps the velocity of its impact as a record, but it is at rest.
  for (const LandedBead& b : stage.landed) {
    const std::size_t k = b.bead + 1;
    if (k > links.last) continue;
    const double impact = vx[b.bead] * dx[k] + vy[b.bead] * dy[k] + vz[b.bead] * dz[k];
    out[k] += g * impact / (l[k] * l[k]);
  }
}

} // namespace ehdjet
