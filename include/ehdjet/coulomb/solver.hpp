#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ehdjet {

/// What a tolerance is relative to. F is the net force, dF its error, f_ij the force of one pair.
enum class ToleranceNorm {
  /// rms |dF_i| <= tolerance F over the charges that move: dF of all of them, F the root mean
  /// square of |F_i| without the strongest tenth. A few charges near a nozzle have 97 to 99 % of
  /// |F|^2 of a jet; those that fly keep the tolerance all the same.
  moving,
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

/// Point charges in the caller's columns, all of length n.
struct PointCharges {
  ConstVec3View r;           ///< [m]
  std::span<const double> q; ///< [C]
  /// 1: the charge moves, 0: it rests. Empty: all move. Looked at in the norm `moving` only.
  std::span<const std::uint8_t> moves = {};
  [[nodiscard]] std::size_t size() const { return q.size(); }
};

/// What comparisons with the direct sum have found so far.
struct CoulombChecks {
  std::size_t number = 0, violations = 0; ///< of checks; of those above the tolerance
  double last = 0, largest = 0;           ///< errors in the norm of the tolerance [-]
};

/// Sums the Coulomb forces of point charges; how it does so is the subclass's business.
///
///     C_i = sum_{j != i} k_C q_i q_j (r_i - r_j) / |r_i - r_j|^3            (model eq. 3)
///
/// shapes : force (n) in the caller's order, *added* to what is there
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

  /// Of all charges on each other. In the norm `moving` nothing is promised about the force on
  /// charges that rest.
  virtual void add_force(const PointCharges& charges, Vec3View force) = 0;

  /// Of the sources on the targets and not back: images, a mat, a part of a chain on another one.
  /// With target charges of 1 it is the field [V/m]. The tolerance holds for the forces on the
  /// targets, in the same norm.
  ///
  /// shapes : sources (m), targets (n) -> force (n)
  /// cost   : direct sum m n pairs, each for one side; treecode O(n log m), fast multipole method
  ///          O(m + n), a far pair as dear as one of `add_force`, which serves both sides
  virtual void add_force_from(const PointCharges& sources, const PointCharges& targets,
                              Vec3View force) = 0;

  /// Energy of charges [J],
  ///
  ///     U = sum over pairs of k_C q_i q_j / |r_i - r_j| ,
  ///
  /// within the tolerance of accuracy() times the sum of the pairs' magnitudes; pairs at zero
  /// distance are skipped. The same bits for any number of threads. By default pair by pair.
  [[nodiscard]] virtual double energy(ConstVec3View r, std::span<const double> q) const;

  /// Pairs at zero distance met by the last call for forces.
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
