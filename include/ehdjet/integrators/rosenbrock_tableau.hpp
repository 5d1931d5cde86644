#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace ehdjet {

/// A linearly implicit Runge-Kutta method (Rosenbrock-W) as data:
///
///     (I - h gamma J) k_i = f(t + alpha_i h, y + h sum_(j<i) a_ij k_j)
///                           + h J sum_(j<i) g_ij k_j + h gamma_i df/dt,   i = 1 ... s
///     y1 = y + h sum_i b_i k_i,   alpha_i = sum_j a_ij,   gamma_i = gamma + sum_j g_ij
///
/// A W-method has its order for every matrix J.
struct RosenbrockTableau {
  std::string_view name;              ///< as in the scene file
  std::string_view description;       ///< one line, with its source
  int order;                          ///< of the propagated solution
  int error_order;                    ///< the error estimate falls with h to this power
  double gamma;                       ///< on the diagonal
  std::vector<std::vector<double>> a; ///< row i: (i), strictly lower triangular
  std::vector<std::vector<double>> g; ///< the same
  std::vector<double> b;              ///< (s)
  std::vector<double> embedded;       ///< (s), weights of the solution of lower order
};

/// All methods, in the order in which they are documented. Of at least third order.
std::span<const RosenbrockTableau> rosenbrock_tableaus();

} // namespace ehdjet
