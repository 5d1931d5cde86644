#pragma once

#include <cstddef>
#include <vector>

namespace ehdjet::detail {

/// Normalised solid harmonics, the functions in which far charges are expanded.
///
///     R_l^m(r) = sqrt((l-m)!/(l+m)!) r^l P_l^m(cos theta) e^(i m phi),   0 <= m <= l <= p
///
/// so that  1/|r - a| = sum_lm conj(R_l^m(a)) R_l^m(r)/r^(2l+1),  |a| < |r|,  and sums over m do
/// not change when the axes are turned. R_l^-m = (-1)^m conj(R_l^m) is not stored.
///
/// A set of coefficients is (p+1)^2 numbers, degree after degree:
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
constexpr std::size_t real_part(int l, int m) {
  return square(l) + (m == 0 ? 0 : 2 * static_cast<std::size_t>(m) - 1);
}
constexpr std::size_t imaginary_part(int l, int m) { // m > 0
  return real_part(l, m) + 1;
}

inline constexpr int highest_order = 22;

/// Numbers that the operators need and that depend on the order only, in the sequence in which
/// the kernels read them.
struct ExpansionNumbers {
  int order;
  /// Exchange of the x and z axes, an involution: per l and m the factors of Re c_l^n with n of the
  /// parity of l-m, then those of Im c_l^n with n > 0 of the other parity.
  const double* swap;
  /// Multipole to local expansion along z: per m, k >= m, l >= m:
  /// (l+k)!/sqrt((k-m)!(k+m)!(l-m)!(l+m)!).
  const double* multipole_to_local;
  /// Shift along z: per m, l >= m, j = m ... l:  sqrt((l-m)!(l+m)!/((j-m)!(j+m)!))/(l-j)!.
  const double* shift;
  /// Recursion of R_l^m upwards in l, up to order + 1, per m and l > m: factors of z R_(l-1)^m and
  /// r^2 R_(l-2)^m.
  const double* upward;
  /// R_m^m = diagonal[m] (x + iy) R_(m-1)^(m-1).
  const double* diagonal;
  /// Derivatives, per l <= order and m: what normalised coefficients or harmonics of degree l+1
  /// and order m, m-1, m+1 are multiplied with to stand for degree l and order m.
  const double* gradient;
};

class ExpansionTables {
public:
  explicit ExpansionTables(int order);
  [[nodiscard]] ExpansionNumbers numbers() const;

private:
  void fill_swap();
  void fill_shifts();
  void fill_recursions();

  int order_;
  std::vector<double> swap_, multipole_to_local_, shift_, upward_, diagonal_, gradient_;
};

} // namespace ehdjet::detail
