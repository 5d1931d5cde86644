#pragma once

#include <cstddef>

#include "kernels.hpp"
#include "pair_tiles.hpp"

// The expansion operators for any vector width, with the same rules as in pair_tiles.hpp.
//
// For an operator along a direction d, the axes are turned until d is the z axis. Along z the
// operators are sums over the degree only, so that the total cost is O(p^3). The steps are: turn
// about z until x = 0, exchange x and z, turn about z until y = 0, exchange x and z (Dehnen 2014).
namespace ehdjet::detail {
namespace {

inline constexpr int most_coefficients = (highest_order + 2) * (highest_order + 2);

constexpr int re(int l, int m) {
  return l * l + (m == 0 ? 0 : 2 * m - 1);
}

template <class Vector>
EHDJET_INLINE Vector broadcast(double x) {
  return Vector{} + x;
}

template <class Simd>
EHDJET_INLINE VectorOf<Simd> square_root(const VectorOf<Simd>& v) {
  VectorOf<Simd> root;
  for (int lane = 0; lane < Simd::lanes; ++lane) root[lane] = __builtin_sqrt(v[lane]);
  return root;
}

/// The coefficients of one or two clusters per lane.
template <class Simd, int streams>
struct Sets {
  VectorOf<Simd> c[streams][most_coefficients];
};

template <class Simd>
struct Angles { // cos(m gamma), sin(m gamma)
  VectorOf<Simd> c[highest_order + 1], s[highest_order + 1];
  EHDJET_INLINE Angles(int p, const VectorOf<Simd>& cosine, const VectorOf<Simd>& sine) {
    c[0] = broadcast<VectorOf<Simd>>(1), s[0] = VectorOf<Simd>{};
    for (int m = 1; m <= p; ++m) {
      c[m] = c[m - 1] * cosine - s[m - 1] * sine;
      s[m] = s[m - 1] * cosine + c[m - 1] * sine;
    }
  }
};

/// Turns the axes about z by gamma (sign 1) or back (-1).
template <class Simd, int streams, int sign>
EHDJET_INLINE void turn(int p, const Angles<Simd>& a, Sets<Simd, streams>& set) {
  using Vector = VectorOf<Simd>;
  for (int l = 1; l <= p; ++l)
    for (int m = 1; m <= l; ++m)
      for (int k = 0; k < streams; ++k) {
        Vector &x = set.c[k][re(l, m)], &y = set.c[k][re(l, m) + 1];
        const Vector c = a.c[m], s = sign > 0 ? a.s[m] : -a.s[m];
        const Vector turned = x * c + y * s;
        y = y * c - x * s;
        x = turned;
      }
}

/// Exchanges the x and z axes.
template <class Simd, int streams>
EHDJET_INLINE void exchange_axes(const ExpansionNumbers& tables,
                                 const Sets<Simd, streams>& in, Sets<Simd, streams>& out) {
  using Vector = VectorOf<Simd>;
  const double* t = tables.swap;
  for (int l = 0; l <= tables.order; ++l)
    for (int m = 0; m <= l; ++m) {
      const auto exchange = [&](int part) __attribute__((always_inline)) { // Re or Im
        Vector sum[streams] = {};
        for (int n = part + (l - m) % 2; n <= l; n += 2, ++t)
          for (int k = 0; k < streams; ++k) sum[k] += *t * in.c[k][re(l, n) + part];
        for (int k = 0; k < streams; ++k) out.c[k][re(l, m) + part] = sum[k];
      };
      exchange(0);
      if (m > 0) exchange(1);
    }
}

/// Turns the axes so that d points along z, and back.
template <class Simd>
struct Alignment {
  using Vector = VectorOf<Simd>;
  Vector length;
  Angles<Simd> azimuth, polar;

  EHDJET_INLINE static Vector load_unaligned(const double* p) {
    Vector v;
    for (int lane = 0; lane < Simd::lanes; ++lane) v[lane] = p[lane];
    return v;
  }
  EHDJET_INLINE Alignment(int p, const ExpansionKernel::Batch& b)
      : Alignment(p, load_unaligned(b.dx), load_unaligned(b.dy), load_unaligned(b.dz)) {}
  EHDJET_INLINE Alignment(int p, const Vector& x, const Vector& y, const Vector& z)
      : Alignment(p, x, y, z, square_root<Simd>(x * x + y * y)) {}
  EHDJET_INLINE Alignment(int p, const Vector& x, const Vector& y, const Vector& z,
                          const Vector& rho)
      : length(square_root<Simd>(rho * rho + z * z))
      , azimuth(p, rho > 0.0 ? y / rho : broadcast<Vector>(1),
                rho > 0.0 ? -x / rho : Vector{})
      , polar(p, length > 0.0 ? z / length : broadcast<Vector>(1),
              length > 0.0 ? rho / length : Vector{}) {}

  template <int streams>
  EHDJET_INLINE void align(const ExpansionNumbers& t, Sets<Simd, streams>& set,
                           Sets<Simd, streams>& scratch) const {
    turn<Simd, streams, 1>(t.order, azimuth, set);
    exchange_axes(t, set, scratch);
    turn<Simd, streams, 1>(t.order, polar, scratch);
    exchange_axes(t, scratch, set);
  }
  template <int streams>
  EHDJET_INLINE void restore(const ExpansionNumbers& t, Sets<Simd, streams>& set,
                             Sets<Simd, streams>& scratch) const {
    exchange_axes(t, set, scratch);
    turn<Simd, streams, -1>(t.order, polar, scratch);
    exchange_axes(t, scratch, set);
    turn<Simd, streams, -1>(t.order, azimuth, set);
  }
};

template <class Simd, int streams>
EHDJET_INLINE void gather(int n, const ExpansionKernel::Batch& b,
                          Sets<Simd, streams>& set) {
  for (int k = 0; k < streams; ++k)
    for (int i = 0; i < n; ++i)
      for (int lane = 0; lane < Simd::lanes; ++lane) set.c[k][i][lane] = b.from[k][lane][i];
}

/// The lanes are added one after the other, because a cluster may occur several times in a batch.
template <class Simd>
EHDJET_INLINE void scatter(int n, const VectorOf<Simd>* set, double* const* to) {
  for (int lane = 0; lane < Simd::lanes; ++lane) {
    double* out = to[lane];
    for (int i = 0; i < n; ++i) out[i] += set[i][lane];
  }
}

/// Along z, at distance d:  L_k^m = (-1)^m/d^(k+1) sum_(l<p) (-1)^k/d^l u_kl^m M_l^m,  where u is
/// the table `multipole_to_local`. The sign (-1)^k holds for the field of the first cluster at the
/// second. It becomes (-1)^l for the opposite direction, which is along -z.
///
/// The multipoles have degrees up to p-1, the local expansions up to p. A force is a derivative of
/// the local expansion. It therefore contains products of degrees up to p-1 on both sides, and the
/// sum of the forces vanishes. Multipoles of degree p would violate this, and would not increase the
/// order of the force.
template <class Simd>
// One function, whose sets of coefficients stay where they are. NOLINTNEXTLINE(readability-function-size)
void multipoles_to_locals(const ExpansionNumbers& t, const ExpansionKernel::Batch& batch) {
  using Vector = VectorOf<Simd>;
  const int p = t.order, n = (p + 1) * (p + 1);
  Sets<Simd, 2> a, b;
  gather<Simd, 2>(n, batch, a);
  const Alignment<Simd> axes(p, batch);
  axes.align(t, a, b);

  // The coefficients are scaled with the distance, so that no power of it overflows. The direction
  // for the multipole of the second cluster is -z.
  const Vector inverse = 1.0 / axes.length;
  Vector scale[highest_order + 1];
  scale[0] = broadcast<Vector>(1);
  for (int l = 1; l <= p; ++l) scale[l] = scale[l - 1] * inverse;
  for (int l = 0; l <= p; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      a.c[0][i] *= scale[l];
      a.c[1][i] *= l % 2 == 0 ? scale[l] : -scale[l];
    }
  const double* u = t.multipole_to_local;
  for (int m = 0; m <= p; ++m)
    for (int k = m; k <= p; ++k) {
      Vector real[2] = {}, imaginary[2] = {};
      for (int l = m; l <= p; ++l, ++u) {
        if (l == p) continue; // see above
        const int i = re(l, m);
        for (int side = 0; side < 2; ++side) {
          real[side] += *u * a.c[side][i];
          if (m > 0) imaginary[side] += *u * a.c[side][i + 1];
        }
      }
      const Vector plus = scale[k] * inverse;
      const Vector first = (k + m) % 2 == 0 ? plus : -plus; // of the first cluster's field
      const Vector second = m % 2 == 0 ? plus : -plus;
      b.c[0][re(k, m)] = second * real[1], b.c[1][re(k, m)] = first * real[0];
      if (m > 0) {
        b.c[0][re(k, m) + 1] = second * imaginary[1];
        b.c[1][re(k, m) + 1] = first * imaginary[0];
      }
    }
  axes.restore(t, b, a);
  scatter<Simd>(n, b.c[0], batch.to[0]);
  scatter<Simd>(n, b.c[1], batch.to[1]);
}

/// Along z: M'_l = sum_j s^(l-j) w_lj M_j for multipoles, L'_j = sum_l s^(l-j) w_lj L_l for local
/// expansions.
template <class Simd, bool multipoles>
void shift(const ExpansionNumbers& t, const ExpansionKernel::Batch& batch) {
  using Vector = VectorOf<Simd>;
  const int p = t.order, n = (p + 1) * (p + 1);
  Sets<Simd, 1> a, b;
  gather<Simd, 1>(n, batch, a);
  const Alignment<Simd> axes(p, batch);
  axes.align(t, a, b);
  Vector power[highest_order + 1];
  power[0] = broadcast<Vector>(1);
  // For a multipole the shift is the vector from the new to the old centre, -d.
  const Vector s = multipoles ? -axes.length : axes.length;
  for (int l = 1; l <= p; ++l) power[l] = power[l - 1] * s;
  for (int i = 0; i < n; ++i) b.c[0][i] = Vector{};
  const double* w = t.shift;
  for (int m = 0; m <= p; ++m)
    for (int l = m; l <= p; ++l)
      for (int j = m; j <= l; ++j, ++w) {
        const Vector factor = *w * power[l - j];
        const int to = multipoles ? re(l, m) : re(j, m),
                  from = multipoles ? re(j, m) : re(l, m);
        b.c[0][to] += factor * a.c[0][from];
        if (m > 0) b.c[0][to + 1] += factor * a.c[0][from + 1];
      }
  axes.restore(t, b, a);
  scatter<Simd>(n, b.c[0], batch.to[0]);
}

/// R_l^m for l <= p, for one vector of charges.
template <class Simd>
EHDJET_INLINE void harmonics(const ExpansionNumbers& t, int p, const VectorOf<Simd>& x,
                             const VectorOf<Simd>& y, const VectorOf<Simd>& z,
                             VectorOf<Simd>* r) {
  using Vector = VectorOf<Simd>;
  const Vector square = x * x + y * y + z * z;
  Vector real = broadcast<Vector>(1), imaginary = Vector{};
  const double* up = t.upward;
  for (int m = 0; m <= p; ++m) {
    if (m > 0) {
      const Vector d = broadcast<Vector>(t.diagonal[m]);
      const Vector turned = d * (real * x - imaginary * y);
      imaginary = d * (real * y + imaginary * x);
      real = turned;
    }
    r[re(m, m)] = real;
    if (m > 0) r[re(m, m) + 1] = imaginary;
    Vector below = real, below_i = imaginary, second = Vector{}, second_i = Vector{};
    for (int l = m + 1; l <= p; ++l, up += 2) {
      const Vector f = up[0] * z, g = up[1] * square;
      const Vector next = f * below + g * second;
      second = below, below = next;
      r[re(l, m)] = next;
      if (m == 0) continue;
      const Vector next_i = f * below_i + g * second_i;
      second_i = below_i, below_i = next_i;
      r[re(l, m) + 1] = next_i;
    }
    up += std::ptrdiff_t{2} * (t.order + 1 - p);
  }
}

/// Coordinates of one vector of charges, relative to the centre of an expansion.
template <class Simd>
struct Positions {
  VectorOf<Simd> x, y, z;
  EHDJET_INLINE Positions(const ChargeColumns& c, std::size_t i, const double* centre)
      : x(load<Simd>(c.x + i) * ExpansionKernel::unit - centre[0])
      , y(load<Simd>(c.y + i) * ExpansionKernel::unit - centre[1])
      , z(load<Simd>(c.z + i) * ExpansionKernel::unit - centre[2]) {}
};

template <class Simd>
void charges_to_multipole(const ExpansionNumbers& t, const ChargeColumns& c,
                          std::size_t begin, std::size_t end, const double* centre,
                          double* multipole) {
  using Vector = VectorOf<Simd>;
  const int n = (t.order + 1) * (t.order + 1);
  Vector sum[most_coefficients], r[most_coefficients];
  for (int k = 0; k < n; ++k) sum[k] = Vector{};
  for (std::size_t i = begin; i < end; i += Simd::lanes) {
    Vector q = load<Simd>(c.q + i);
    auto [x, y, z] = Positions<Simd>(c, i, centre);
    for (int lane = 0; lane < Simd::lanes; ++lane)
      if (i + static_cast<std::size_t>(lane)
          >= end) // padding, or charges of another cluster
        q[lane] = x[lane] = y[lane] = z[lane] = 0;
    harmonics<Simd>(t, t.order, x, y, z, r);
    for (int k = 0; k < n; ++k) sum[k] += q * r[k];
  }
  for (int k = 0; k < n; ++k) {
    double total = 0;
    for (int lane = 0; lane < Simd::lanes; ++lane) total += sum[k][lane];
    multipole[k] = total;
  }
}

/// Adds  factor sum_k (gx, gy, gz)_k r_k  to the field of one vector of charges.
template <class Simd>
EHDJET_INLINE void add_field(int n, const double* gx, const double* gy, const double* gz,
                             const VectorOf<Simd>* r, const VectorOf<Simd>& factor,
                             FieldColumns g, std::size_t i) {
  VectorOf<Simd> x{}, y{}, z{};
  for (int k = 0; k < n; ++k) x += gx[k] * r[k], y += gy[k] * r[k], z += gz[k] * r[k];
  store<Simd>(g.x + i, load<Simd>(g.x + i) + factor * x);
  store<Simd>(g.y + i, load<Simd>(g.y + i) + factor * y);
  store<Simd>(g.z + i, load<Simd>(g.z + i) + factor * z);
}

/// -gradient of sum conj(R_l^m) L_l^m, from the derivatives of the harmonics. Each component is a
/// sum of real numbers times Re and Im of R_l^m, l < p.
template <class Simd>
void local_to_charges(const ExpansionNumbers& t, const ChargeColumns& c, FieldColumns g,
                      std::size_t begin, std::size_t end, const double* centre,
                      const double* local) {
  using Vector = VectorOf<Simd>;
  const int p = t.order, n = p * p;
  double gx[most_coefficients], gy[most_coefficients], gz[most_coefficients];
  const double* f = t.gradient;
  for (int l = 0; l < p; ++l)
    for (int m = 0; m <= l; ++m, f += 3) {
      const int i = re(l, m);
      const double *same = local + re(l + 1, m), *above = local + re(l + 1, m + 1);
      const double b1 = f[2] * above[0], b2 = f[2] * above[1];
      if (m == 0) {
        gx[i] = -b1, gy[i] = -b2, gz[i] = f[0] * same[0];
        continue;
      }
      const double* below = local + re(l + 1, m - 1);
      const double a1 = f[1] * below[0], a2 = m > 1 ? f[1] * below[1] : 0;
      gx[i] = a1 - b1, gx[i + 1] = a2 - b2;
      gy[i] = -(a2 + b2), gy[i + 1] = a1 + b1;
      gz[i] = 2 * f[0] * same[0], gz[i + 1] = 2 * f[0] * same[1];
    }
  // The coordinates of the columns are larger by 1/unit, and fields are smaller by unit^2.
  constexpr double scale = -ExpansionKernel::unit * ExpansionKernel::unit;
  Vector r[most_coefficients];
  for (std::size_t i = begin; i < end; i += Simd::lanes) {
    const auto [x, y, z] = Positions<Simd>(c, i, centre);
    harmonics<Simd>(t, p - 1, x, y, z, r);
    add_field<Simd>(n, gx, gy, gz, r, broadcast<Vector>(scale), g, i);
  }
}

/// Coefficients of the irregular harmonics R_l^m(d)/d^(2l+1), l <= p+1, in the three components of
/// the gradient of the potential of a multipole.
template <class Simd>
void multipole_gradient(const ExpansionNumbers& t, const double* multipole,
                        double* gradient) {
  const int p = t.order, n = (p + 2) * (p + 2);
  double *gx = gradient, *gy = gx + n, *gz = gy + n;
  for (int i = 0; i < 3 * n; ++i) gradient[i] = 0;
  const double* f = t.gradient;
  for (int l = 0; l <= p; ++l)
    for (int m = 0; m <= l; ++m, f += 3) {
      const double real = multipole[re(l, m)],
                   imaginary = m > 0 ? multipole[re(l, m) + 1] : 0;
      const int same = re(l + 1, m), below = re(l + 1, m - 1), above = re(l + 1, m + 1);
      gz[same] -= (m > 0 ? 2 : 1) * f[0] * real;
      if (m > 0) {
        gz[same + 1] -= 2 * f[0] * imaginary;
        gx[below] -= f[1] * real, gy[below] -= f[1] * imaginary;
        if (m > 1) gx[below + 1] -= f[1] * imaginary, gy[below + 1] += f[1] * real;
      }
      gx[above] += f[2] * real, gx[above + 1] += f[2] * imaginary;
      gy[above] -= f[2] * imaginary, gy[above + 1] += f[2] * real;
    }
}

/// field -= gradient, at charges [begin, end).
template <class Simd>
void multipole_to_charges(const ExpansionNumbers& t, const ChargeColumns& c, FieldColumns g,
                          std::size_t begin, std::size_t end, const double* centre,
                          const double* gradient) {
  using Vector = VectorOf<Simd>;
  const int p = t.order, n = (p + 2) * (p + 2);
  const double *gx = gradient, *gy = gx + n, *gz = gy + n;
  constexpr double scale = -ExpansionKernel::unit * ExpansionKernel::unit;
  Vector r[most_coefficients];
  for (std::size_t i = begin; i < end; i += Simd::lanes) {
    const auto [x, y, z] = Positions<Simd>(c, i, centre);
    const Vector inverse = 1.0 / (x * x + y * y + z * z); // R_l(d/d^2)/d = R_l(d)/d^(2l+1)
    harmonics<Simd>(t, p + 1, x * inverse, y * inverse, z * inverse, r);
    add_field<Simd>(n, gx, gy, gz, r, scale * square_root<Simd>(inverse), g, i);
  }
}

/// sum of q_i phi(r_i), phi = sum_l (M_l^0 I_l^0 + 2 sum_(m>0) Re(conj(M_l^m) I_l^m)) with the
/// irregular harmonics I_l^m = R_l^m(d)/d^(2l+1).
template <class Simd>
double energy_in_multipole(const ExpansionNumbers& t, const ChargeColumns& c,
                           std::size_t begin, std::size_t end, const double* centre,
                           const double* multipole) {
  using Vector = VectorOf<Simd>;
  const int p = t.order;
  double weighted[most_coefficients];
  for (int l = 0; l <= p; ++l)
    for (int i = re(l, 0); i < re(l + 1, 0); ++i)
      weighted[i] = (i == re(l, 0) ? 1 : 2) * multipole[i];
  Vector sum = Vector{}, r[most_coefficients];
  for (std::size_t i = begin; i < end; i += Simd::lanes) {
    const auto [x, y, z] = Positions<Simd>(c, i, centre);
    const Vector inverse = 1.0 / (x * x + y * y + z * z);
    harmonics<Simd>(t, p, x * inverse, y * inverse, z * inverse, r);
    Vector potential = Vector{};
    for (int k = 0; k < re(p + 1, 0); ++k) potential += weighted[k] * r[k];
    sum += load<Simd>(c.q + i) * square_root<Simd>(inverse) * potential;
  }
  double total = 0;
  for (int lane = 0; lane < Simd::lanes; ++lane) total += sum[lane];
  return total;
}

template <class Simd>
ExpansionKernel expansion_kernel() {
  return {static_cast<std::size_t>(Simd::lanes),
          charges_to_multipole<Simd>,
          local_to_charges<Simd>,
          multipoles_to_locals<Simd>,
          shift<Simd, true>,
          shift<Simd, false>,
          multipole_gradient<Simd>,
          multipole_to_charges<Simd>,
          energy_in_multipole<Simd>};
}

} // namespace
} // namespace ehdjet::detail
