#pragma once

#include <cstddef>
#include <vector>

namespace ehdjet::detail {

/// Normalised solid harmonics, the functions of the expansions:
///
///     R_l^m(r) = sqrt((l-m)!/(l+m)!) r^l P_l^m(cos theta) e^(i m phi),   0 <= m <= l <= p
///
/// With this norm  1/|r - a| = sum_lm conj(R_l^m(a)) R_l^m(r)/r^(2l+1)  for |a| < |r|,  and sums
/// over m are invariant under rotations. R_l^-m = (-1)^m conj(R_l^m) is not stored.
///
/// A coefficient set has (p+1)^2 numbers, degree after degree:
///
///     Re c_l^0, Re c_l^1, Im c_l^1, ..., Re c_l^l, Im c_l^l
///
/// source : van Gelderen, DEOS Progress Letters 98.1 (1998) 57;
///          Dehnen, Comput. Astrophys. Cosmol. 1 (2014) 1
constexpr std::size_t square(int n) {
  return static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
}
constexpr std::size_t coefficients(int order) {
  return square(order + 1);
}
/// Index of Re c_l^m in a coefficient set.
constexpr std::size_t real_part(int l, int m) {
  return square(l) + (m == 0 ? 0 : 2 * static_cast<std::size_t>(m) - 1);
}

inline constexpr int highest_order = 22;

/// The number of rows of a matrix that are multiplied together, if so many rows are left. Blocks
/// have at most four rows, and no block has a single row if this can be avoided.
constexpr int rows_of_block(int left) {
  return left <= 4 ? left : left < 8 ? (left + 1) / 2 : 4;
}

/// Numbers of the operators that depend only on the order, in the sequence in which the kernels
/// read them.
struct ExpansionNumbers {
  int order;
  /// Exchange of the x and z axes, an involution. For each l: the factors of Re c_l^n in Re c_l^m
  /// for even m, then for odd m, with n of the parity of l-m. After these the factors of Im c_l^n in
  /// Im c_l^m for odd m, then for even m, with n of the other parity. In each of the four, successive
  /// m form blocks (`rows_of_block`). For each block and n there is one factor per m.
  const double* swap;
  /// Multipole to local expansion along z. For each m, two successive k >= m, l = m ... p-1 and each
  /// of the two k:  (l+k)!/sqrt((k-m)!(k+m)!(l-m)!(l+m)!).
  const double* multipole_to_local;
  /// Shift along z. For each m, l >= m, j = m ... l:  sqrt((l-m)!(l+m)!/((j-m)!(j+m)!))/(l-j)!.
  const double* shift;
  /// Recursion of R_l^m in l, up to order + 1. For each m and l > m: the factors of z R_(l-1)^m and
  /// r^2 R_(l-2)^m.
  const double* upward;
  /// R_m^m = diagonal[m] (x + iy) R_(m-1)^(m-1).
  const double* diagonal;
  /// Derivatives. For each l <= order and m: the factors of normalised coefficients or harmonics of
  /// degree l+1 and order m, m-1, m+1 in those of degree l and order m.
  const double* gradient;
};

class ExpansionTables {
public:
  explicit ExpansionTables(int order);
  [[nodiscard]] ExpansionNumbers numbers() const;

private:
  void fill_swap();
  void fill_multipole_to_local();

  int order_;
  std::vector<double> swap_, multipole_to_local_, shift_, upward_, diagonal_, gradient_;
};

} // namespace ehdjet::detail
