#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/forces/link_derivatives.hpp"
#include "ehdjet/jet/jet_columns.hpp"

#include <Eigen/LU>

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Solves (I - eta J) x = b for the local part J of a chain's Jacobian, x = (r, v, sigma), in O(n).
///
/// With D the difference over a link, eliminating the columns sigma of links and then r,
///
///     r = b_r + eta v,   sigma = s + p . D v
///     s = E (b_s + eta turning . D b_r),   p = E (eta stretching + eta^2 turning)
///
/// where E = 1/(1 + eta/tau) or, of two columns that act on each other, the inverse of the 2x2 matrix
/// 1 + eta relaxation. That leaves a block-tridiagonal 3x3 system in v, with
/// A = eta^2 pull + sum eta tension p^T + eta damping over the columns,
///
///     (m_k + eta drag_k) v_k - A_(k+1) D_(k+1) v + A_k D_k v
///         = m_k b_v + eta (pull_(k+1) D_(k+1) b_r + sum tension_(k+1) s_(k+1) - the same of link k)
///
/// (A and pull as on the upper end in link k+1, on the lower end in link k), solved by block
/// elimination with pivoting inside the blocks. A link answers with the stiffness G/(1 + eta/tau),
/// which goes to mu/eta as G grows. Nothing is assumed to be symmetric or definite.
///
/// cost   : O(n); allocates only when n grows
/// laws   : with x = 0 for beads that are held and links that are frozen, theirs stays 0
class ChainJacobian {
public:
  /// Zeroes all derivatives. `first`: first bead below bead 0 with a link; its upstream is bead 0.
  void reset(std::size_t beads, std::size_t first);
  [[nodiscard]] LinkDerivatives& links() { return links_; }
  [[nodiscard]] const LinkDerivatives& links() const { return links_; }
  /// Nothing changes that bead's position and velocity.
  void hold(std::size_t bead) { held_[bead] = 1; }
  /// Nothing changes the columns of that link.
  void freeze(std::size_t link);
  [[nodiscard]] bool is_held(std::size_t bead) const { return held_[bead] != 0; }

  void factorize(double eta, std::span<const double> mass);
  /// x: the integrated columns; those that no term has derivatives of stay as they are.
  void solve(std::span<double> x) const;

  /// omega^2 of the fastest modes if neighbours move in opposite phase, bounds by rows:
  /// 2 (K_k + K_(k+1))/m_k for the stiffness K of the links [1/s^2].
  struct Rates {
    double elastic = 0; ///< K = sum of tension . stretching
    double tension = 0; ///< K = |pull|
  };
  [[nodiscard]] Rates squared_rates(std::span<const double> inverse_mass) const;
  /// The fastest decay of a column of links at rest, for pairs a bound by rows [1/s].
  [[nodiscard]] double relaxation_rate() const;
  /// The fastest decay by damping, a bound of the same kind, or by drag [1/s].
  [[nodiscard]] double damping_rate(std::span<const double> inverse_mass) const;

private:
  void eliminate_columns(double eta);
  /// s, in place; returns the sum of tension times s.
  [[nodiscard]] Vec3 eliminated_pull(std::size_t k, const Vec3& d,
                                     const JetColumns<double>& x) const;
  [[nodiscard]] std::size_t upstream(std::size_t k) const {
    return k == first_ ? 0 : k - 1;
  }

  LinkDerivatives links_;
  std::vector<char> held_;
  std::size_t first_ = 1;

  // Of the last factorization.
  double eta_ = 0;
  std::span<const double> mass_;
  /// How a column of links is eliminated.
  struct Elimination {
    std::vector<Vec3> response;  // p
    std::vector<double> damping; // E: of the column itself,
    std::vector<double> partner; // and of the other one of its pair
  };
  std::vector<Elimination> eliminations_; // of each column
  std::vector<Mat3> lower_,
      eliminated_; // A at the lower end; inverse pivot times A at the upper
  std::vector<Eigen::PartialPivLU<Mat3>> pivot_;
};

} // namespace ehdjet
