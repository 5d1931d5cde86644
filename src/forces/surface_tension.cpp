#include "ehdjet/forces/surface_tension.hpp"

#include "ehdjet/jet/curvature.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "link_tension.hpp"

namespace ehdjet {
void BendingSurfaceTension::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data(), *v = stage.volume.data();
  radius_.resize(links.length.size());
  double *a = radius_.data(), *fx = force.x.data(), *fy = force.y.data(),
         *fz = force.z.data();
#pragma omp simd
  for (std::size_t k = links.first; k <= links.last; ++k)
    a[k] = std::sqrt(v[k] / (std::numbers::pi * l[k]));

  const double alpha = coefficient_;
#pragma omp simd
  for (std::size_t k = links.first; k < links.last; ++k) {
    const Curvature c = curvature(-dx[k], -dy[k], -dz[k], dx[k + 1], dy[k + 1], dz[k + 1]);
    const double mean_radius = (a[k] + a[k + 1]) / 2;
    const double strength = alpha * std::numbers::pi * mean_radius * mean_radius;
    fx[k] += strength * c.x, fy[k] += strength * c.y, fz[k] += strength * c.z;
  }
}

void LineSurfaceTension::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data();
  tension_per_length_.assign(links.length.size(), 0.0);
  double* t = tension_per_length_.data();
  const double alpha = coefficient_;
#pragma omp simd
  for (std::size_t k = links.first; k <= links.last; ++k) // pi a alpha / l
    t[k] = alpha * std::sqrt(std::numbers::pi * v[k] / l[k]) / l[k];
  add_link_tension(links, tension_per_length_, force);
}

} // namespace ehdjet
