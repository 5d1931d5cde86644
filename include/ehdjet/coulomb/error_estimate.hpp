#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>

namespace ehdjet {

/// The error of a Coulomb force in each norm [-]. On a smooth chain the pair forces nearly cancel.
/// The first two norms are relative to the net force of all charges and show this; the third is not.
/// The last two are relative to the net force on each charge, which no solver can bound.
struct CoulombErrorSample {
  double relative_moving = 0;
  double relative_l2 = 0;
  double worst_per_target = 0;
  double median_of_net = 0, worst_of_net = 0;
  std::size_t targets = 0; ///< number of sampled targets

  [[nodiscard]] double in(ToleranceNorm norm) const {
    return norm == ToleranceNorm::moving   ? relative_moving
           : norm == ToleranceNorm::global ? relative_l2
                                           : worst_per_target;
  }
};

/// Compares `force`, which must come from these charges only, with a plain direct sum in long
/// double. The targets i are up to `max_targets` evenly spaced charges, which all move for the norm
/// `moving`:
///
///     relative_moving  = sqrt( <|dF_i|^2> / <|F_i|^2 of all but the strongest tenth> )
///     relative_l2      = sqrt( sum_i |dF_i|^2 / sum_i |F_i|^2 )
///     worst_per_target = max_i |dF_i| / sum_j |f_ij|,   |f_ij| = k_C |q_i q_j| / r_ij^2
///     median_of_net, worst_of_net: median and maximum of |dF_i| / |F_i|
///
/// A ratio 0/0 counts as 0. With a long double of 80 bits the error of the reference is about
/// 1e-19 sqrt(n) sum_j |f_ij|.
///
/// shapes : force (n)                 units : [N]
/// cost   : max_targets * n pairs of about 15 ns, shared by all threads
/// errors : ContractViolation if sizes differ or `max_targets` is 0
CoulombErrorSample sampled_error(const PointCharges& charges, ConstVec3View force,
                                 ToleranceNorm norm = ToleranceNorm::global,
                                 std::size_t max_targets = 2000);

} // namespace ehdjet
