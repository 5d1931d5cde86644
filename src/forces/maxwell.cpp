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

// With F = V sigma d/l^2, sigma' = G (w.d)/l^2 - sigma/tau:
//     dF/dd = V sigma/l^2 (I - 2 t t^T),      dF/d sigma = V d/l^2
//     d sigma'/dw = G d/l^2,                  d sigma'/dd = G/l^2 (w - 2 (w.t) t)
void Maxwell::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  const auto sigma = stage.columns.stress();
  auto landed = stage.landed.begin();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t upstream = k == links.first ? 0 : k - 1;
    while (landed != stage.landed.end() && landed->bead < upstream) ++landed;
    const bool rests = landed != stage.landed.end() && landed->bead == upstream;
    const double l = links.length[k], stiffness = elastic_modulus_ / (l * l);
    const Vec3 d(links.dx[k], links.dy[k], links.dz[k]), t = d / l;
    const Vec3 w = rests ? v[k] : Vec3(v[k] - v[upstream]);
    const double area_per_length = stage.volume[k] / (l * l);
    out.add_pull(k,
                 area_per_length * sigma[k] * (Mat3::Identity() - 2 * t * t.transpose()));
    out.tension[k] += area_per_length * d;
    out.stretching[k] += stiffness * d;
    out.turning[k] += stiffness * (w - 2 * w.dot(t) * t);
    out.relaxation[k] += relaxation_rate_;
  }
}

} // namespace ehdjet
