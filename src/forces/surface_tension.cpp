#include "ehdjet/forces/surface_tension.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "link_tension.hpp"

namespace ehdjet {
namespace {

// K as three numbers: the one place where it is written, for the vector and the bead loop.
struct Curvature {
  double x, y, z;
};

inline Curvature curvature(double ux, double uy, double uz, double wx, double wy,
                           double wz) {
  const double uu = ux * ux + uy * uy + uz * uz, ww = wx * wx + wy * wy + wz * wz;
  const double px = uy * wz - uz * wy, py = uz * wx - ux * wz, pz = ux * wy - uy * wx;
  const double bx = uu * wx - ww * ux, by = uu * wy - ww * uy, bz = uu * wz - ww * uz;
  const double ex = ux - wx, ey = uy - wy, ez = uz - wz;
  const double denominator = uu * ww * (ex * ex + ey * ey + ez * ez);
  // Beads k-1 and k+1 in one place: no circle, and p = 0 anyway.
  const double s = denominator > 0 ? 2 / denominator : 0.0;
  return {s * (by * pz - bz * py), s * (bz * px - bx * pz), s * (bx * py - by * px)};
}

} // namespace

Vec3 curvature_vector(const Vec3& u, const Vec3& w) {
  const Curvature k = curvature(u.x(), u.y(), u.z(), w.x(), w.y(), w.z());
  return {k.x, k.y, k.z};
}

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
