#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ehdjet {

/// What a tolerance is relative to.
enum class ToleranceNorm {
  global,  ///< |dF|_2 <= tolerance |F|_2 over all charges
  per_bead ///< |dF_i| <= tolerance sum_j |f_ij| for every charge
};

/// What a solver promises about its result: an error, in the norm, of at most `tolerance`. It is 0
/// for the direct sum, whose only error is round-off. The others stay well below it on jets; where
/// the errors of all clusters add up with one sign, as on a ring, they may reach twice the
/// tolerance.
struct CoulombAccuracy {
  double tolerance = 0; ///< [-]
  ToleranceNorm norm = ToleranceNorm::global;
};

/// What comparisons with the direct sum have found so far.
struct CoulombChecks {
  std::size_t number = 0, violations = 0; ///< of checks; of those above the tolerance
  double last = 0, largest = 0;           ///< errors in the norm of the tolerance [-]
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
  /// What the next calls depend on besides their arguments.
  virtual void archive(const Archive& /*a*/) {}
  /// None if nobody checks.
  [[nodiscard]] virtual std::optional<CoulombChecks> checks() const { return {}; }
};

} // namespace ehdjet
