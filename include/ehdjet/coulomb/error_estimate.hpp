#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>

namespace ehdjet {

/// How far a computed Coulomb force is from the exact one, in each norm. On a smooth chain
/// the net force is a small residue of large terms: the first two show that, the third not.
struct CoulombErrorSample {
  double relative_moving =
      0; ///< [-] rms error over the rms net force, strongest tenth left out
  double relative_l2 = 0;      ///< [-] over all sampled targets
  double worst_per_target = 0; ///< [-] relative to what acts on it, before cancelling
  std::size_t targets = 0;     ///< how many were sampled

  [[nodiscard]] double in(ToleranceNorm norm) const {
    return norm == ToleranceNorm::moving   ? relative_moving
           : norm == ToleranceNorm::global ? relative_l2
                                           : worst_per_target;
  }
};

/// Compares `force` (from nothing but these charges) with a plain direct sum in long double,
/// on up to `max_targets` evenly spaced targets i, for the norm `moving` among those that move:
///
///     relative_moving  = sqrt( <|dF_i|^2> / <|F_i|^2 of all but the strongest tenth> )
///     relative_l2      = sqrt( sum_i |dF_i|^2 / sum_i |F_i|^2 )
///     worst_per_target = max_i |dF_i| / sum_j |f_ij|,   |f_ij| = k_C |q_i q_j| / r_ij^2
///
/// A ratio 0/0 is 0. Where long double is 80 bits wide the reference is good to 1e-19 sqrt(n)
/// of sum_j |f_ij|.
///
/// shapes : force (n)                 units : [N]
/// cost   : max_targets * n pairs of about 15 ns, shared by all threads
/// errors : sizes that differ, or no target allowed, are a ContractViolation
CoulombErrorSample sampled_error(const PointCharges& charges, ConstVec3View force,
                                 ToleranceNorm norm = ToleranceNorm::global,
                                 std::size_t max_targets = 2000);

} // namespace ehdjet
