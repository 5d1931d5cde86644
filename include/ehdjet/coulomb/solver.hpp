#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ehdjet {

/// What a solver promises about its result.
///
/// `tolerance` bounds the relative L2 error of the net force over all charges,
///
///     | F - F_direct |_2 / | F_direct |_2 ,
///
/// and is 0 for the direct sum, whose only error is round-off. The others stay well below it on jets; where
/// the errors of all clusters add up with one sign, as on a ring, they may reach twice the tolerance.
struct CoulombAccuracy {
  double tolerance = 0; ///< [-]
};

/// Sums the mutual Coulomb force of n point charges; how it does so is the subclass's business.
///
///     C_i = sum_{j != i} k_C q_i q_j (r_i - r_j) / |r_i - r_j|^3            (model eq. 3)
///
/// shapes : r (n), q (n) -> force (n), in the caller's order, *added* to what is there
/// units  : [m], [C] -> [N]; k_C is `constants::coulomb`
/// laws   : a pair at zero distance is skipped (never NaN) and counted in `coincident_pairs()`;
///          the same input gives the same bits for a given number of threads
/// cost   : whatever depends on n alone is kept between calls; a call with an n that was seen
///          before allocates nothing. Positions may move freely from call to call
/// errors : sizes that differ are a ContractViolation. Coordinates must be finite
/// source : Jackson, Classical Electrodynamics, 3rd ed. (1999), ch. 1
class CoulombSolver {
public:
  virtual ~CoulombSolver() = default;

  virtual void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) = 0;

  /// Energy of the same charges [J],
  ///
  ///     U = sum over pairs of k_C q_i q_j / |r_i - r_j| ,
  ///
  /// within the tolerance of accuracy() times the sum of the pairs' magnitudes; pairs at zero
  /// distance are skipped. The same bits for any number of threads. By default pair by pair.
  [[nodiscard]] virtual double energy(ConstVec3View r, std::span<const double> q);

  /// Pairs at zero distance met by the last `add_force`.
  [[nodiscard]] virtual std::size_t coincident_pairs() const = 0;
  [[nodiscard]] virtual CoulombAccuracy accuracy() const = 0;
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// What does the work and why, for people to read.
  [[nodiscard]] virtual std::string description() const { return std::string(name()); }
  /// Makes the criterion that keeps the tolerance stricter, after a violation.
  virtual void tighten() {}
  /// Relative L2 error at the last check against the direct sum; none if there are no checks.
  [[nodiscard]] virtual std::optional<double> measured_error() const { return {}; }
  /// Checks that found more than the tolerance.
  [[nodiscard]] virtual std::size_t violations() const { return 0; }
};

} // namespace ehdjet
