#pragma once

#include "ehdjet/core/columns.hpp"

namespace ehdjet {

/// Curvature vector at a bead with neighbours at u = r_(k-1) - r_k and w = r_(k+1) - r_k: 1/R of
/// the circle through the three beads, towards its centre.
///
///     K = 2 (|u|^2 w - |w|^2 u) x p / (|u|^2 |w|^2 |u-w|^2),   p = u x w      (model 2) [1/m]
///
/// laws   : exactly 0 for collinear beads, finite when the chain folds back on itself
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
inline Vec3 curvature_vector(const Vec3& u, const Vec3& w) {
  const Curvature k = curvature(u.x(), u.y(), u.z(), w.x(), w.y(), w.z());
  return {k.x, k.y, k.z};
}

} // namespace ehdjet
