#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/forces/link_derivatives.hpp"

#include <Eigen/LU>

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Solves (I - eta J) x = b for the local part J of a chain's Jacobian, x = (r, v, sigma), in O(n).
///
/// With D the difference over a link, eliminating sigma and then r,
///
///     r = b_r + eta v,   sigma = s + p . D v
///     s = (b_s + eta turning . D b_r) / (1 + eta/tau)
///     p = (eta stretching + eta^2 turning) / (1 + eta/tau)
///
/// leaves a block-tridiagonal 3x3 system in v, with A = eta^2 pull + eta tension p^T + eta damping,
///
///     (m_k + eta drag_k) v_k - A_(k+1) D_(k+1) v + A_k D_k v
///         = m_k b_v + eta (pull_(k+1) D_(k+1) b_r + tension_(k+1) s_(k+1) - the same of link k)
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
  /// Nothing changes that link's sigma.
  void freeze(std::size_t link);
  [[nodiscard]] bool is_held(std::size_t bead) const { return held_[bead] != 0; }

  void factorize(double eta, std::span<const double> mass);
  /// x: the integrated columns; those that are neither r, v nor sigma stay as they are.
  void solve(std::span<double> x) const;

  /// omega^2 of the fastest modes if neighbours move in opposite phase, bounds by rows:
  /// 2 (K_k + K_(k+1))/m_k for the stiffness K of the links [1/s^2].
  struct Rates {
    double elastic = 0; ///< K = tension . stretching
    double tension = 0; ///< K = |pull|
  };
  [[nodiscard]] Rates squared_rates(std::span<const double> inverse_mass) const;
  /// The fastest decay by damping, a bound of the same kind, or by drag [1/s].
  [[nodiscard]] double damping_rate(std::span<const double> inverse_mass) const;

private:
  [[nodiscard]] std::size_t upstream(std::size_t k) const {
    return k == first_ ? 0 : k - 1;
  }

  LinkDerivatives links_;
  std::vector<char> held_;
  std::size_t first_ = 1;

  // Of the last factorization.
  double eta_ = 0;
  std::span<const double> mass_;
  std::vector<Vec3> response_;  // p
  std::vector<double> damping_; // 1/(1 + eta/tau)
  std::vector<Mat3> lower_,
      eliminated_; // A at the lower end; inverse pivot times A at the upper
  std::vector<Eigen::PartialPivLU<Mat3>> pivot_;
};

} // namespace ehdjet
