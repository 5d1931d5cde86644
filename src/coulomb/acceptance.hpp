#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <algorithm>
#include <cmath>

#include "multipoles.hpp"

namespace ehdjet::detail {

/// Which pairs of clusters act by their expansions: those for which the tails of the series are
/// small enough. `allowed` is the error of a force by one pair, without k_C, in the units of the
/// clusters, or for the norm `per_bead` relative to the force of the pair.
struct Acceptance {
  double opening = 0; ///< largest radius over distance
  int order = 0;
  bool per_bead = false;
  double allowed = 0;

  /// Multipole of the source, felt by each charge of the target.
  [[nodiscard]] bool one_sided(const Cluster& source, const Cluster& target) const;
  /// Multipole of the source and local expansion about the target; `mutual`: and back.
  [[nodiscard]] bool two_sided(const Cluster& source, const Cluster& target,
                               bool mutual) const;
};

/// Larger than the distance of close pairs, which no series may contain, in the units of clusters.
inline constexpr double no_closer = 0x1p10 * close_distance * ExpansionKernel::unit;

/// Square of the distance at which a tail is compared with a force: that of the centres, on which
/// the criterion is calibrated, but at most twice the distance to the nearest charge there may be. A
/// cluster with a long link in it reaches far beyond its charges.
inline double reach(double d, double nearest) {
  const double reach = std::min(d, 2 * nearest);
  return reach * reach;
}

inline bool Acceptance::one_sided(const Cluster& source, const Cluster& target) const {
  const double d = between(source.centre, target.centre).norm();
  const double to_target = d - target.radius;
  if (!(source.radius + no_closer < opening * to_target)) return false;
  const double tail = source.lumped * power(source.radius / to_target, order + 1);
  if (per_bead) return tail <= allowed;
  return source.charge * std::sqrt(target.square) * tail <= allowed * reach(d, to_target);
}

inline bool Acceptance::two_sided(const Cluster& source, const Cluster& target,
                                  bool mutual) const {
  const double d = between(source.centre, target.centre).norm();
  const double to_target = d - target.radius, to_source = d - source.radius;
  if (!(source.radius + no_closer < opening * to_target)) return false;
  if (!(target.radius + no_closer < opening * to_source)) return false;
  const double tail = source.lumped * power(source.radius / to_target, order)
                      + target.lumped * power(target.radius / to_source, order);
  if (per_bead) return tail <= allowed;
  double force = source.charge * std::sqrt(target.square);
  if (mutual) force = std::max(force, target.charge * std::sqrt(source.square));
  return force * tail <= allowed * reach(d, std::min(to_target, to_source));
}

/// Whether all charges of both clusters are in one place, or nearer to it than kernels can tell.
inline bool in_one_place(const Cluster& a, const Cluster& b) {
  return a.radius == 0 && b.radius == 0 && between(a.centre, b.centre).norm() == 0;
}

} // namespace ehdjet::detail
