#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace ehdjet {

/// An explicit Runge-Kutta method as data, so that one loop serves every method.
///
///     k_i = f(t + c_i h, y + h sum_j a_ij k_j),   i = 0 ... s-1
///     y1  = y + h sum_i b_i k_i,                  k_s = f(t + h, y1)
///
/// Weights that refer to stages may have an entry for k_s, and, in `dense`, for `extra` stages
/// that are evaluated only when dense output is asked for.
struct ButcherTableau {
  struct Stage {
    double c;
    std::vector<double> a;
  };
  std::string_view name;        ///< as in the scene file
  std::string_view description; ///< one line, with its source
  int order;                    ///< of the propagated solution
  std::vector<Stage> stages;    ///< s of them
  std::vector<double> b;        ///< (s)
  /// Differences to embedded solutions, each (s) or (s+1). None: no error estimate. Two: the
  /// estimate is e0^2 / sqrt(e0^2 + 0.01 e1^2) (Hairer, Norsett & Wanner, II.10).
  std::vector<std::vector<double>> error;
  int error_order = 0; ///< the estimate falls with h to this power
  std::vector<Stage> extra;
  /// Dense output beyond the cubic Hermite polynomial, see RungeKutta::dense_output.
  std::vector<std::vector<double>> dense;
};

/// All methods, in the order in which they are documented.
std::span<const ButcherTableau> butcher_tableaus();
/// The method of that name.
/// errors : InputError that lists the known names, for a name that is not among them
const ButcherTableau& butcher_tableau(std::string_view name);

} // namespace ehdjet
