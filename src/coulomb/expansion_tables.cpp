#include "expansion_tables.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet::detail {
namespace {

using Real = long double;

Real factorial(int n) {
  return n < 2 ? 1 : static_cast<Real>(n) * factorial(n - 1);
}

// Factor from plain harmonics (r^l P_l^m e^(im phi)/(l+m)!) to normalised ones.
Real norm(int l, int m) {
  return std::sqrt(factorial(l - m) * factorial(l + m));
}

/// Plain harmonics of degree l in axes with x and z exchanged: S R_l^m = sum_n B_l[m][n] R_l^n. The
/// recursion in l follows from the derivatives of both sides.
class Exchange {
public:
  explicit Exchange(int l)
      : l_(l)
      , b_(square(2 * l + 1)) {
    if (l == 0) b_[0] = 1;
  }
  [[nodiscard]] Exchange next() const {
    Exchange up(l_ + 1);
    for (int m = -l_ - 1; m <= l_ + 1; ++m) {
      for (int n = -l_; n <= l_; ++n)
        up.at(m, n) = ((*this)(m + 1, n) - (*this)(m - 1, n)) / 2;
      const auto edge = [&](int k) { return ((*this)(m + 1, k) + (*this)(m - 1, k)) / 2; };
      up.at(m, -l_ - 1) = (*this)(m, -l_) + edge(-l_);
      up.at(m, l_ + 1) = edge(l_) - (*this)(m, l_);
    }
    return up;
  }
  Real operator()(int m, int n) const { // 0 outside the matrix
    if (std::abs(m) > l_ || std::abs(n) > l_) return 0;
    return b_[index(m, n)];
  }
  [[nodiscard]] Real normalised(int m, int n) const {
    return (*this)(m, n) * norm(l_, m) / norm(l_, n);
  }

private:
  [[nodiscard]] std::size_t index(int m, int n) const {
    const int place = (m + l_) * (2 * l_ + 1) + n + l_;
    return static_cast<std::size_t>(place);
  }
  Real& at(int m, int n) { return b_[index(m, n)]; }
  int l_;
  std::vector<Real> b_;
};

Real parity(int n) {
  return n % 2 == 0 ? 1 : -1;
}

void push(std::vector<double>& v, Real x) {
  v.push_back(static_cast<double>(x));
}

} // namespace

ExpansionTables::ExpansionTables(int p)
    : order_(p) {
  EHDJET_EXPECTS(p >= 1 && p <= highest_order);
  fill_swap();
  fill_multipole_to_local();
  for (int m = 0; m <= p; ++m)
    for (int l = m; l <= p; ++l)
      for (int j = m; j <= l; ++j) push(shift_, norm(l, m) / norm(j, m) / factorial(l - j));
  for (int m = 0; m <= p + 1; ++m)
    for (int l = m + 1; l <= p + 1; ++l) {
      const Real d = static_cast<Real>(l + m) * (l - m);
      push(upward_, (2 * l - 1) / d * norm(l, m) / norm(l - 1, m));
      push(upward_, l - 2 < m ? 0 : -norm(l, m) / norm(l - 2, m) / d);
    }
  push(diagonal_, 1);
  for (int m = 1; m <= p + 1; ++m)
    push(diagonal_, -norm(m, m) / norm(m - 1, m - 1) / (2 * m));
  for (int l = 0; l <= p; ++l)
    for (int m = 0; m <= l; ++m)
      for (const int n : {m, m - 1, m + 1}) push(gradient_, norm(l + 1, n) / norm(l, m));
}

void ExpansionTables::fill_swap() {
  Exchange s(0);
  for (int l = 0; l <= order_; ++l) {
    if (l > 0) s = s.next();
    const auto factor = [&](int m, int n, int part) {
      if (n == 0) return s.normalised(m, 0);
      const Real other = parity(n) * s.normalised(m, -n);
      return part == 0 ? s.normalised(m, n) + other : s.normalised(m, n) - other;
    };
    for (int part = 0; part < 2; ++part)
      for (int first = part; first <= part + 1; ++first)
        for (int m = first, rows = 0; m <= l; m += 2 * rows) {
          rows = rows_of_block((l - m) / 2 + 1);
          for (int n = part + (l + first) % 2; n <= l; n += 2)
            for (int r = 0; r < rows; ++r) push(swap_, factor(m + 2 * r, n, part));
        }
  }
}

void ExpansionTables::fill_multipole_to_local() {
  for (int m = 0; m <= order_; ++m)
    for (int first = m; first <= order_; first += 2)
      for (int l = m; l < order_; ++l)
        for (int k = first; k <= std::min(first + 1, order_); ++k)
          push(multipole_to_local_, factorial(l + k) / (norm(k, m) * norm(l, m)));
}

ExpansionNumbers ExpansionTables::numbers() const {
  return {order_,          swap_.data(),   multipole_to_local_.data(),
          shift_.data(),   upward_.data(), diagonal_.data(),
          gradient_.data()};
}

} // namespace ehdjet::detail
