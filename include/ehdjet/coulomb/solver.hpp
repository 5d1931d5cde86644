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

/// The force to which a tolerance is relative. F is the net force, dF its error, f_ij the force of
/// one pair.
enum class ToleranceNorm {
  /// rms |dF_i| <= tolerance F over the charges that move, where F is the root mean square of |F_i|
  /// without the strongest tenth. A few charges near a nozzle have 97 to 99 % of |F|^2 of a jet.
  /// This norm keeps the tolerance also for the other charges.
  moving,
  global,  ///< |dF|_2 <= tolerance |F|_2 over all charges
  per_bead ///< |dF_i| <= tolerance sum_j |f_ij| for every charge
};

/// The error that a solver allows. It is 0 for the direct sum, which has only round-off errors. The
/// errors of the other solvers are below the tolerance on jets, in the norm `moving` mostly a third
/// to two thirds of it. On a ring, where the errors of all clusters have the same sign, they may
/// reach twice the tolerance.
struct CoulombAccuracy {
  double tolerance = 0; ///< [-]
  ToleranceNorm norm = ToleranceNorm::global;
};

/// Point charges in the caller's columns, all of length n.
struct PointCharges {
  ConstVec3View r;           ///< [m]
  std::span<const double> q; ///< [C]
  /// 1: the charge moves, 0: it is at rest. Empty: all move. Used only by the norm `moving`.
  std::span<const std::uint8_t> moves = {};
  /// Sources of add_force_from with the same identity are the same charges in the same places, in all
  /// calls of a solver. It keeps their tree and multipoles, and the object, so that no others can have
  /// its address. Null: they may be any.
  std::shared_ptr<const void> identity = nullptr;
  [[nodiscard]] std::size_t size() const { return q.size(); }
};

/// Results of the comparisons with the direct sum so far.
struct CoulombChecks {
  std::size_t number = 0, violations = 0; ///< all checks, and those above the tolerance
  double last = 0, largest = 0;           ///< errors in the norm of the tolerance [-]
};

/// U_C = sum over pairs of k_C q_i q_j / |r_i - r_j|, pair by pair [J].
///
/// shapes : r (n), q (n), [m], [C]. Pairs at zero distance are skipped.
/// laws   : the same bits for any number of threads
double coulomb_energy(ConstVec3View r, std::span<const double> q);

/// Sums the Coulomb forces of point charges.
///
///     C_i = sum_{j != i} k_C q_i q_j (r_i - r_j) / |r_i - r_j|^3            (model eq. 3)
///
/// shapes : force (n) in the caller's order; the result is *added* to it
/// units  : [m], [C] -> [N]; k_C is `constants::coulomb`
/// laws   : a pair at zero distance is skipped (never NaN) and counted in `coincident_pairs()`;
///          the same input gives the same bits for a given number of threads
/// cost   : everything that depends on n alone is kept between calls: a call with an n that has
///          occurred before allocates nothing. Positions may change arbitrarily between calls
/// errors : ContractViolation if sizes differ. Coordinates must be finite
/// source : Jackson, Classical Electrodynamics, 3rd ed. (1999), ch. 1
class CoulombSolver {
public:
  virtual ~CoulombSolver() = default;

  /// The forces of all charges on each other. In the norm `moving` the forces on charges at rest
  /// need not keep the tolerance.
  virtual void add_force(const PointCharges& charges, Vec3View force) = 0;

  /// The forces of the sources on the targets only: of image charges, of a mat, or of one part of a
  /// chain on another. With target charges of 1 the result is the field [V/m]. The tolerance holds
  /// for the forces on the targets, in the same norm.
  ///
  /// shapes : sources (m), targets (n) -> force (n)
  /// cost   : direct sum m n pairs, treecode O(n log m), fast multipole method O(m + n). A pair of
  ///          distant clusters costs the same as in `add_force`, where it acts in both directions
  virtual void add_force_from(const PointCharges& sources, const PointCharges& targets,
                              Vec3View force) = 0;

  /// `coulomb_energy` within the tolerance of accuracy() times the sum of the pairs' magnitudes. It
  /// gives the same bits for any number of threads. The default computes every pair.
  [[nodiscard]] virtual double energy(ConstVec3View r, std::span<const double> q) const {
    return coulomb_energy(r, q);
  }

  /// Number of pairs at zero distance in the last call for forces.
  [[nodiscard]] virtual std::size_t coincident_pairs() const = 0;
  [[nodiscard]] virtual CoulombAccuracy accuracy() const = 0;
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// A text for the user: the method, its parameters and why it was chosen.
  [[nodiscard]] virtual std::string description() const { return std::string(name()); }
  /// Makes the acceptance criterion stricter, after a violation of the tolerance.
  virtual void tighten() {}
  /// Saves or restores everything that the next calls depend on, besides their arguments.
  virtual void archive(const Archive& /*a*/) {}
  /// Empty if the solver is not checked.
  [[nodiscard]] virtual std::optional<CoulombChecks> checks() const { return {}; }
};

} // namespace ehdjet
