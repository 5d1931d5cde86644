#pragma once

#include <cstddef>
#include <utility>

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

/// The coefficients of one or two clusters per lane. The last line is not used. It keeps two sets
/// from having the same addresses modulo 4096, for which loads would wait for stores.
template <class Simd, int streams>
struct Sets {
  VectorOf<Simd> c[most_coefficients + 1][streams];
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
  for (int m = 1; m <= p; ++m) {
    const Vector c = a.c[m], s = sign > 0 ? a.s[m] : -a.s[m];
    for (int l = m, i = re(m, m); l <= p; i += 2 * l + 1, ++l) // i = re(l, m)
      for (int k = 0; k < streams; ++k) {
        Vector &x = set.c[i][k], &y = set.c[i + 1][k];
        const Vector turned = x * c + y * s;
        y = y * c - x * s;
        x = turned;
      }
  }
}

/// Sums of a few rows of a matrix times one or more vectors x. All sums stay in registers, and each
/// element of x is loaded only once.
template <class Simd, int rows, int streams>
struct Rows {
  VectorOf<Simd> sum[rows][streams] = {};

  EHDJET_INLINE void add(const double* column, const VectorOf<Simd>* x) {
#pragma GCC unroll 4
    for (int k = 0; k < streams; ++k)
#pragma GCC unroll 4
      for (int r = 0; r < rows; ++r) sum[r][k] += column[r] * x[k];
  }
};

/// Exchanges the x and z axes in Re (part 0) or Im (1) of c_l^m, c_l^(m+2), ... The compiler knows the
/// length of each loop. The loops are so short that their control would otherwise take longer than
/// the arithmetic.
template <class Simd, int streams, int l, int part, int m>
EHDJET_INLINE void exchange_rows(const double*& t, const VectorOf<Simd> (*in)[streams],
                                 VectorOf<Simd> (*out)[streams]) {
  if constexpr (m <= l) {
    constexpr int rows = rows_of_block((l - m) / 2 + 1);
    Rows<Simd, rows, streams> block;
    constexpr int first = part + (l + m) % 2, next = first == 0 ? 2 : first;
    if constexpr (first == 0) block.add(t, in[re(l, 0)]), t += rows;
    auto* x = in + re(l, next) + part;
#pragma GCC unroll 1
    for (int n = next; n <= l; n += 2, t += rows, x += 4) block.add(t, *x);
#pragma GCC unroll 4
    for (int r = 0; r < rows; ++r)
#pragma GCC unroll 4
      for (int k = 0; k < streams; ++k) out[re(l, m + 2 * r) + part][k] = block.sum[r][k];
    exchange_rows<Simd, streams, l, part, m + 2 * rows>(t, in, out);
  }
}

/// Exchanges the x and z axes, from degree l on.
template <class Simd, int streams, int l = 0>
void exchange_axes(const ExpansionNumbers& tables, const double* t,
                   const VectorOf<Simd> (*in)[streams], VectorOf<Simd> (*out)[streams]) {
  exchange_rows<Simd, streams, l, 0, 0>(t, in, out);
  exchange_rows<Simd, streams, l, 0, 1>(t, in, out);
  exchange_rows<Simd, streams, l, 1, 1>(t, in, out);
  exchange_rows<Simd, streams, l, 1, 2>(t, in, out);
  if constexpr (l < highest_order)
    if (l < tables.order) exchange_axes<Simd, streams, l + 1>(tables, t, in, out);
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
    exchange_axes<Simd, streams>(t, t.swap, set.c, scratch.c);
    turn<Simd, streams, 1>(t.order, polar, scratch);
    exchange_axes<Simd, streams>(t, t.swap, scratch.c, set.c);
  }
  template <int streams>
  EHDJET_INLINE void restore(const ExpansionNumbers& t, Sets<Simd, streams>& set,
                             Sets<Simd, streams>& scratch) const {
    exchange_axes<Simd, streams>(t, t.swap, set.c, scratch.c);
    turn<Simd, streams, -1>(t.order, polar, scratch);
    exchange_axes<Simd, streams>(t, t.swap, scratch.c, set.c);
    turn<Simd, streams, -1>(t.order, azimuth, set);
  }
};

/// Every other block of `step` lanes of a and b: the first ones, or those that remain (`second`).
template <int step, bool second, class Vector, int... lane>
EHDJET_INLINE Vector every_other(const Vector& a, const Vector& b,
                                 std::integer_sequence<int, lane...> /*lanes*/) {
  constexpr int lanes = sizeof...(lane);
  return __builtin_shufflevector(
      a, b, (lane + (second ? step : 0) + ((lane & step) != 0 ? lanes - step : 0))...);
}

/// Transposes a matrix of `lanes` rows, from blocks of one element to blocks of half the size.
template <class Simd, int step = 1>
EHDJET_INLINE void transpose(VectorOf<Simd>* v) {
  using Vector = VectorOf<Simd>;
  constexpr std::make_integer_sequence<int, Simd::lanes> lanes;
  if constexpr (step < Simd::lanes) {
#pragma GCC unroll 8
    for (int i = 0; i < Simd::lanes; ++i) {
      if ((i & step) != 0) continue;
      const Vector a = v[i], b = v[i + step];
      v[i] = every_other<step, false>(a, b, lanes);
      v[i + step] = every_other<step, true>(a, b, lanes);
    }
    transpose<Simd, 2 * step>(v);
  }
}

/// Successive coefficients of a cluster become the same lane of successive vectors.
template <class Simd, int streams>
EHDJET_INLINE void gather(int n, const ExpansionKernel::Batch& b,
                          Sets<Simd, streams>& set) {
  using Vector = VectorOf<Simd>;
  for (int i = 0; i < n; i += Simd::lanes)
    for (int k = 0; k < streams; ++k) {
      Vector v[Simd::lanes];
#pragma GCC unroll 8
      for (int lane = 0; lane < Simd::lanes; ++lane)
        __builtin_memcpy(&v[lane], b.from[k][lane] + i, sizeof(Vector));
      transpose<Simd>(v);
#pragma GCC unroll 8
      for (int j = 0; j < Simd::lanes; ++j) set.c[i + j][k] = v[j];
    }
}

/// The lanes are added one after the other, because a cluster may occur several times in a batch.
template <class Simd, int streams>
EHDJET_INLINE void scatter(int n, Sets<Simd, streams>& set,
                           const ExpansionKernel::Batch& b) {
  using Vector = VectorOf<Simd>;
  for (int i = n; i % Simd::lanes != 0; ++i) // padding
    for (int k = 0; k < streams; ++k) set.c[i][k] = Vector{};
  for (int i = 0; i < n; i += Simd::lanes)
    for (int k = 0; k < streams; ++k) {
      Vector v[Simd::lanes];
#pragma GCC unroll 8
      for (int j = 0; j < Simd::lanes; ++j) v[j] = set.c[i + j][k];
      transpose<Simd>(v);
#pragma GCC unroll 8
      for (int lane = 0; lane < Simd::lanes; ++lane) {
        Vector sum;
        __builtin_memcpy(&sum, b.to[k][lane] + i, sizeof(Vector));
        sum += v[lane];
        __builtin_memcpy(b.to[k][lane] + i, &sum, sizeof(Vector));
      }
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
      a.c[i][0] *= scale[l];
      a.c[i][1] *= l % 2 == 0 ? scale[l] : -scale[l];
    }
  const double* u = t.multipole_to_local;
  const auto along_z = [&]<int rows, int parts>(int k, int m)
      __attribute__((always_inline)) {
    Rows<Simd, rows, 2 * parts> block; // Re and Im are adjacent
    for (int l = m, i = re(m, m); l < p; i += 2 * l + 1, ++l, u += rows)
      block.add(u, a.c[i]); // i = re(l, m)
#pragma GCC unroll 2
    for (int r = 0; r < rows; ++r) {
      const Vector plus = scale[k + r] * inverse;
      const Vector first =
          (k + r + m) % 2 == 0 ? plus : -plus; // of the first cluster's field
      const Vector second = m % 2 == 0 ? plus : -plus;
#pragma GCC unroll 2
      for (int part = 0; part < parts; ++part) {
        b.c[re(k + r, m) + part][0] = second * block.sum[r][2 * part + 1];
        b.c[re(k + r, m) + part][1] = first * block.sum[r][2 * part];
      }
    }
  };
  for (int m = 0; m <= p; ++m) {
    int k = m;
    for (; k < p; k += 2)
      m == 0 ? along_z.template operator()<2, 1>(k, m)
             : along_z.template operator()<2, 2>(k, m);
    if (k == p)
      m == 0 ? along_z.template operator()<1, 1>(k, m)
             : along_z.template operator()<1, 2>(k, m);
  }
  axes.restore(t, b, a);
  scatter<Simd>(n, b, batch);
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
  for (int i = 0; i < n; ++i) b.c[i][0] = Vector{};
  const double* w = t.shift;
  for (int m = 0; m <= p; ++m)
    for (int l = m; l <= p; ++l)
      for (int j = m; j <= l; ++j, ++w) {
        const Vector factor = *w * power[l - j];
        const int to = multipoles ? re(l, m) : re(j, m),
                  from = multipoles ? re(j, m) : re(l, m);
        b.c[to][0] += factor * a.c[from][0];
        if (m > 0) b.c[to + 1][0] += factor * a.c[from + 1][0];
      }
  axes.restore(t, b, a);
  scatter<Simd>(n, b, batch);
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
    if (i + Simd::lanes > end)
      for (int lane = 0; lane < Simd::lanes; ++lane)
        if (i + static_cast<std::size_t>(lane)
            >= end) // padding, or charges of another cluster
          q[lane] = x[lane] = y[lane] = z[lane] = 0;
    harmonics<Simd>(t, t.order, x, y, z, r);
    for (int k = 0; k < n; ++k) sum[k] += q * r[k];
  }
  for (int k = 0; k < n; ++k) multipole[k] = detail::sum<Simd>(sum[k]);
}

/// Adds  factor sum_k (gx, gy, gz)_k r_k  to the field of one vector of charges.
template <class Simd>
EHDJET_INLINE void add_field(int n, const double* gx, const double* gy, const double* gz,
                             const VectorOf<Simd>* r, const VectorOf<Simd>& factor,
                             FieldColumns g, std::size_t i) {
  // Two sums per component, because one would have to wait for its last term at each step.
  VectorOf<Simd> x[2]{}, y[2]{}, z[2]{};
  const auto add = [&](int sum, int k) __attribute__((always_inline)) {
    x[sum] += gx[k] * r[k], y[sum] += gy[k] * r[k], z[sum] += gz[k] * r[k];
  };
  for (int k = 0; k + 1 < n; k += 2) add(0, k), add(1, k + 1);
  if (n % 2 == 1) add(0, n - 1);
  store<Simd>(g.x + i, load<Simd>(g.x + i) + factor * (x[0] + x[1]));
  store<Simd>(g.y + i, load<Simd>(g.y + i) + factor * (y[0] + y[1]));
  store<Simd>(g.z + i, load<Simd>(g.z + i) + factor * (z[0] + z[1]));
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
  return detail::sum<Simd>(sum);
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
