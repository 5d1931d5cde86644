#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "multipoles.hpp"

namespace ehdjet::detail {

/// The smallest distance of a charge from a cluster that acts on it by an expansion of this order, in
/// the units of clusters. Close pairs are excluded, which no series may contain, and distances whose
/// power of `order` + 2 underflows. There are such ones only beside an outlier that is at least 1e12
/// times as far away as the others.
[[nodiscard]] inline double closest_of(int order) {
  return std::max(0x1p10 * close_distance * ExpansionKernel::unit,
                  std::exp2(-1000.0 / (order + 2)));
}
/// More than the round-off of d minus a radius, for centres at distance d. The ball of a cluster with an
/// outlier is nearly as large as its distance from all others.
[[nodiscard]] inline double round_off_of(double d) {
  return 0x1p-44 * d;
}

/// Decides which pairs of clusters act by their expansions: those with small enough tails of the
/// series.
struct Acceptance {
  double opening = 0; ///< largest radius over distance
  int order = 0;
  double closest = closest_of(order);
  bool per_bead = false;
  /// The allowed error of the force of one pair: relative to this force for the norm `per_bead`,
  /// otherwise without k_C in the units of the clusters.
  double allowed = 0;
  /// Charges have very different density: dense ones act like one on those around them.
  bool uneven = false;

  /// For the multipole of the source, evaluated at each charge of the target.
  [[nodiscard]] bool one_sided(const Cluster& source, const Cluster& target) const {
    const double d = between(source.centre, target.centre).norm();
    const double to_target = d - target.radius, gap = closest + round_off_of(d);
    if (!(source.radius + gap < opening * to_target)) return false;
    const double tail = source.lumped * power(source.radius / to_target, order + 1);
    if (per_bead) return tail <= allowed;
    return source.charge * std::sqrt(target.square) * tail <= allowed * reach(d, to_target);
  }
  /// For the multipole of the source and a local expansion about the target. If `mutual`, the
  /// target acts on the source in the same way.
  [[nodiscard]] bool two_sided(const Cluster& source, const Cluster& target,
                               bool mutual) const {
    const Displacement path = between(source.centre, target.centre);
    const double d = path.norm();
    const double to_target = d - target.radius, to_source = d - source.radius,
                 gap = closest + round_off_of(d);
    if (!(source.radius + gap < opening * to_target)) return false;
    if (!(target.radius + gap < opening * to_source)) return false;
    const double of_source = source.lumped * power(source.radius / to_target, order)
                             * (mutual ? alone(target, source) : 1),
                 of_target = target.lumped * power(target.radius / to_source, order)
                             * alone(source, target);
    double force = 1, limit = allowed;
    if (!per_bead) {
      force = source.charge * std::sqrt(target.square);
      if (mutual) force = std::max(force, target.charge * std::sqrt(source.square));
      limit = allowed * reach(d, std::min(to_target, to_source));
    }
    // Most pairs are decided without the directions of the axes.
    const double most = force * (of_source + of_target);
    if (most <= limit) return true;
    if (!(most * std::sqrt(beside_squared()) <= limit)) return false;
    return force
               * (beside(source, path, d) * of_source + beside(target, path, d) * of_target)
           <= limit;
  }

private:
  /// Along a curve the errors at a charge of local expansions of many clusters average out. Charges
  /// at a single place act through one expansion, whose tail at the edge of the target is larger by
  /// its degree. (A leaf of a single charge is weak.) So do those that are much closer to each other than
  /// the charges of the other cluster.
  [[nodiscard]] double alone(const Cluster& c, const Cluster& other) const {
    constexpr double much_closer = 0.25;
    const double extent = uneven ? much_closer * other.radius : 0;
    return c.radius <= extent && c.end - c.begin > padding ? order + 1 : 1;
  }
  /// The part of a tail that remains in the direction of `path`. The terms of degree p of a charge
  /// in the direction gamma are proportional to P_p(cos gamma), for which Bernstein's bound is
  /// |P_p| < sqrt(2/(pi (p + 1/2) sin gamma)).  The field beside a straight cluster is therefore more
  /// accurate than on its axis. The charges that matter are in the outer part of a cluster, where
  /// its width is seen at an angle of up to width/(0.8 radius).
  [[nodiscard]] double beside(const Cluster& c, const Displacement& path, double d) const {
    const double cosine =
        (c.axis[0] * path.x + c.axis[1] * path.y + c.axis[2] * path.z) / d;
    const double sine =
        std::sqrt(std::max(0.0, 1 - cosine * cosine)) - c.width / (0.8 * c.radius);
    const double square = beside_squared();
    return sine > square ? std::sqrt(square / sine) : 1;
  }
  /// Its least square, at right angles.
  [[nodiscard]] double beside_squared() const {
    return 2 / (std::numbers::pi * (order + 0.5));
  }
  /// Square of the distance at which a tail is compared with a force. The criterion is calibrated
  /// for the distance of the centres. The limit is twice the smallest possible distance of a
  /// charge, because a cluster with a long link reaches far beyond its charges.
  static double reach(double d, double nearest) {
    const double reach = std::min(d, 2 * nearest);
    return reach * reach;
  }
};

/// Whether all charges of both clusters have the same place, or places that the kernels cannot
/// distinguish.
inline bool in_one_place(const Cluster& a, const Cluster& b) {
  return a.radius == 0 && b.radius == 0 && between(a.centre, b.centre).norm() == 0;
}

} // namespace ehdjet::detail
