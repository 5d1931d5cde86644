#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <algorithm>
#include <cmath>

#include "multipoles.hpp"

namespace ehdjet::detail {

/// x^n, n >= 0.
inline double power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

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

inline bool Acceptance::one_sided(const Cluster& source, const Cluster& target) const {
  const double d = between(source.centre, target.centre).norm();
  const double to_target = d - target.radius;
  if (!(source.radius < opening * to_target)) return false;
  const double tail = power(source.radius / to_target, order + 1);
  if (per_bead) return tail <= allowed;
  return source.charge * std::sqrt(target.square) * tail <= allowed * d * d;
}

inline bool Acceptance::two_sided(const Cluster& source, const Cluster& target,
                                  bool mutual) const {
  const double d = between(source.centre, target.centre).norm();
  const double to_target = d - target.radius, to_source = d - source.radius;
  if (!(source.radius < opening * to_target)) return false;
  if (!(target.radius < opening * to_source)) return false;
  double tail = power(source.radius / to_target, order);
  tail += power(target.radius / to_source, order);
  if (per_bead) return tail <= allowed;
  double force = source.charge * std::sqrt(target.square);
  if (mutual) force = std::max(force, target.charge * std::sqrt(source.square));
  return force * tail <= allowed * d * d;
}

} // namespace ehdjet::detail
