#pragma once

#include <cstddef>

#include "pair_kernel.hpp"

// The pair kernel for any vector width. One source file per instruction set includes it. All of it
// has internal linkage and uses no standard functions: the linker could otherwise use an inline
// function that was compiled for one instruction set in files for another.
namespace ehdjet::detail {
namespace {

#define EHDJET_INLINE [[gnu::always_inline]] inline

/// Each source file defines a class `Simd` for its instruction set:
///
///     Vector, Mask             `lanes` doubles; as many 64-bit integers
///     targets, vectors         shape of a tile: beads and vectors of sources. It fills the
///                              registers and gives enough independent operations
///     degree                   of the polynomial below, 0 if the estimate is exact
///     inverse_sqrt(r2)         estimate of r2^-1/2, for r2 in [2^-120, 2^126]
///     smaller(a, b), any_below(a, bound)
template <class Simd>
using VectorOf = typename Simd::Vector;

/// r^-3 from an estimate y of 1/r. With e = 1 - r^2 y^2 it is exactly y^3 (1 - e)^(-3/2), and
///
///     (1 - e)^(-3/2) = 1 + 3/2 e + 15/8 e^2 + 35/16 e^3 + 315/128 e^4 + 693/256 e^5 + ...
///
/// For |e| <= 2^-13 (14-bit estimate) the terms after e^3 are below 6e-16. For |e| <= 7.4e-4
/// (12 bits) this holds for the terms after e^4.
template <class Simd>
EHDJET_INLINE VectorOf<Simd> inverse_cube(const VectorOf<Simd>& r2) {
  using Vector = VectorOf<Simd>;
  const Vector y = Simd::inverse_sqrt(r2), y2 = y * y, y3 = y * y2;
  if constexpr (Simd::degree == 0) return y3;
  const Vector e = 1.0 - r2 * y2;
  Vector p = 1.875 + e * 2.1875;
  if constexpr (Simd::degree == 4) p = 1.875 + e * (2.1875 + e * 2.4609375);
  return y3 + (y3 * e) * (1.5 + e * p); // this order has the shortest dependency chain
}

template <class Simd>
EHDJET_INLINE VectorOf<Simd> load(const double* p) {
  return *reinterpret_cast<const VectorOf<Simd>*>(p);
}
template <class Simd>
EHDJET_INLINE void store(double* p, const VectorOf<Simd>& v) {
  *reinterpret_cast<VectorOf<Simd>*>(p) = v;
}
template <class Simd>
EHDJET_INLINE double sum(const VectorOf<Simd>& v) {
  double s = v[0];
  for (int lane = 1; lane < Simd::lanes; ++lane) s += v[lane];
  return s;
}

/// A few beads, each repeated in all lanes, and the fields at their places.
template <class Simd>
struct Targets {
  using Vector = VectorOf<Simd>;
  Vector x[Simd::targets], y[Simd::targets], z[Simd::targets], q[Simd::targets];
  Vector gx[Simd::targets], gy[Simd::targets], gz[Simd::targets];

  EHDJET_INLINE Targets(const ChargeColumns& c, std::size_t i) {
    for (int t = 0; t < Simd::targets; ++t, ++i) {
      x[t] = Vector{} + c.x[i], y[t] = Vector{} + c.y[i], z[t] = Vector{} + c.z[i];
      q[t] = Vector{} + c.q[i];
      gx[t] = gy[t] = gz[t] = Vector{};
    }
  }
  EHDJET_INLINE void add_to(FieldColumns g, std::size_t i) const {
    for (int t = 0; t < Simd::targets; ++t, ++i)
      g.x[i] += sum<Simd>(gx[t]), g.y[i] += sum<Simd>(gy[t]), g.z[i] += sum<Simd>(gz[t]);
  }
};

template <class Vector>
EHDJET_INLINE Vector magnitude(const Vector& v) {
  return v < 0.0 ? -v : v;
}

/// r_target - r_source of all pairs of a tile. The index is k = vector * targets + target.
template <class Simd, int vectors>
struct Separations {
  using Vector = VectorOf<Simd>;
  using Mask = typename Simd::Mask;
  static constexpr int chains = Simd::targets * vectors;
  Vector dx[chains], dy[chains], dz[chains], r2[chains];

  EHDJET_INLINE Separations(const ChargeColumns& c, std::size_t j,
                            const Targets<Simd>& target) {
#pragma GCC unroll 16
    for (int k = 0; k < chains; ++k) {
      const int t = k % Simd::targets;
      const std::size_t source = j + std::size_t(k / Simd::targets) * Simd::lanes;
      dx[k] = target.x[t] - load<Simd>(c.x + source);
      dy[k] = target.y[t] - load<Simd>(c.y + source);
      dz[k] = target.z[t] - load<Simd>(c.z + source);
      r2[k] = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
    }
  }

  /// Leaves out pairs with source <= target. A bead is then not close to itself.
  EHDJET_INLINE void keep_sources_behind(std::size_t i, std::size_t j) {
#pragma GCC unroll 16
    for (int k = 0; k < chains; ++k) {
      Mask behind;
      for (int lane = 0; lane < Simd::lanes; ++lane) {
        const std::size_t source = j + std::size_t(k / Simd::targets * Simd::lanes + lane);
        behind[lane] = source > i + std::size_t(k % Simd::targets) ? -1 : 0;
      }
      r2[k] = behind ? r2[k] : Vector{} + 1.0;
      dx[k] = behind ? dx[k] : Vector{};
      dy[k] = behind ? dy[k] : Vector{};
      dz[k] = behind ? dz[k] : Vector{};
    }
  }

  /// False only if no pair is close: max|d| < close gives r^2 < 3 close^2, plus rounding errors.
  [[nodiscard]] EHDJET_INLINE bool may_be_close() const {
    Vector smallest = r2[0];
#pragma GCC unroll 16
    for (int k = 1; k < chains; ++k) smallest = Simd::smaller(smallest, r2[k]);
    return Simd::any_below(smallest, 4 * close_distance * close_distance);
  }

  EHDJET_INLINE void leave_out_close() {
#pragma GCC unroll 16
    for (int k = 0; k < chains; ++k) {
      const Mask close = (magnitude(dx[k]) < close_distance)
                         & (magnitude(dy[k]) < close_distance)
                         & (magnitude(dz[k]) < close_distance);
      r2[k] = close ? Vector{} + 0x1p120 : r2[k]; // then d/r^3 < 2^-240 has no effect
    }
  }
};

/// Adds the fields of one tile: `Simd::targets` beads from i on, and `vectors` vectors of sources
/// from j on. `diagonal`: the two ranges overlap. `mutual`: the targets also act on the sources.
/// Returns whether the tile may have a close pair.
template <class Simd, int vectors, bool diagonal, bool mutual>
EHDJET_INLINE bool add_tile(const ChargeColumns& c, FieldColumns g, std::size_t i,
                            std::size_t j, Targets<Simd>& target) {
  using Vector = VectorOf<Simd>;
  Separations<Simd, vectors> d(c, j, target);
  if constexpr (diagonal) d.keep_sources_behind(i, j);
  const bool met_close = d.may_be_close();
  if (__builtin_expect(met_close, 0)) d.leave_out_close();

  Vector w[d.chains];
#pragma GCC unroll 16
  for (int k = 0; k < d.chains; ++k) w[k] = inverse_cube<Simd>(d.r2[k]);

#pragma GCC unroll 8
  for (int v = 0; v < vectors; ++v) {
    const std::size_t source = j + std::size_t(v) * Simd::lanes;
    const Vector q = load<Simd>(c.q + source);
#pragma GCC unroll 8
    for (int t = 0; t < Simd::targets; ++t) {
      const int k = v * Simd::targets + t;
      const Vector to_target = w[k] * q;
      target.gx[t] += to_target * d.dx[k];
      target.gy[t] += to_target * d.dy[k];
      target.gz[t] += to_target * d.dz[k];
    }
    if constexpr (!mutual) continue;
    Vector gx = load<Simd>(g.x + source), gy = load<Simd>(g.y + source),
           gz = load<Simd>(g.z + source);
#pragma GCC unroll 8
    for (int t = 0; t < Simd::targets; ++t) {
      const int k = v * Simd::targets + t;
      const Vector to_source = w[k] * target.q[t];
      gx -= to_source * d.dx[k];
      gy -= to_source * d.dy[k];
      gz -= to_source * d.dz[k];
    }
    store<Simd>(g.x + source, gx);
    store<Simd>(g.y + source, gy);
    store<Simd>(g.z + source, gz);
  }
  return met_close;
}

template <class Simd, bool mutual>
void add_fields(const ChargeColumns& charges, FieldColumns g, TileRows rows,
                unsigned char* close) {
  static_assert(padding % Simd::lanes == 0 && padding % Simd::targets == 0);
  constexpr std::size_t lanes = Simd::lanes, targets = Simd::targets;
  constexpr std::size_t wide = lanes * Simd::vectors;
  const ChargeColumns c = charges; // a copy, so that stores to g cannot change the pointers
  for (std::size_t row = rows.first;
       row < rows.last && (!mutual || row * targets < rows.end); row += rows.stride) {
    const std::size_t i = row * targets;
    Targets<Simd> target(c, i);
    bool met_close = false;
    std::size_t j = rows.begin;
    if constexpr (mutual) {
      if (const std::size_t own = i / lanes * lanes; j < own) j = own;
      for (; j < i + targets; j += lanes)
        met_close |= add_tile<Simd, 1, true, true>(c, g, i, j, target);
    }
    for (; j + wide <= rows.end; j += wide)
      met_close |= add_tile<Simd, Simd::vectors, false, mutual>(c, g, i, j, target);
    if constexpr (Simd::vectors > 1)
      for (; j < rows.end; j += lanes)
        met_close |= add_tile<Simd, 1, false, mutual>(c, g, i, j, target);
    target.add_to(g, i);
    if (met_close) close[row] = 1;
  }
}

template <class Simd>
PairKernel pair_kernel() {
  return {add_fields<Simd, true>, add_fields<Simd, false>, Simd::targets};
}

} // namespace
} // namespace ehdjet::detail
