#pragma once

#include <cstddef>

namespace ehdjet::detail {

/// Point charges for the kernels: 64-byte aligned columns, scaled by powers of two and padded, so
/// that the inner loop needs neither a range check nor a remainder.
///
///     |x|, |y|, |z| < 2^57,  |q| < 1;  padding: q = 0, at x = 2^58, 2 2^58, 3 2^58, ...
///
/// Then r^2 < 2^126 does not overflow in single precision, in which r^-1 is first estimated.
struct ChargeColumns {
  const double *x, *y, *z, *q;
};
inline constexpr int coordinate_exponent = 57;
inline constexpr double padding_distance = 0x1p58;
inline constexpr std::size_t padding = 8; ///< the length of columns is a multiple of this

/// The unit of memory of columns and of coefficient sets. Vectors that cross cache lines are slow.
struct alignas(64) CacheLine {
  double value[padding];
};

/// A pair is *close* if max(|dx|, |dy|, |dz|) < close_distance. This test has no rounding error. The
/// kernels skip close pairs, for which r^2 might be subnormal in single precision, and set a flag.
inline constexpr double close_distance = 0x1p-60;

struct FieldColumns {
  double *x, *y, *z;
};

/// Tiles of consecutive targets, with the numbers first, first + stride, ... < last, and the sources
/// [begin, end), which are multiples of `padding`.
struct TileRows {
  std::size_t first, last, stride, begin, end;
};

/// Adds fields  sum_j q_j (r_i - r_j)/|r_i - r_j|^3. Sets close[t] if tile t of the targets has a
/// close pair, and never clears it.
using AddFields = void (*)(const ChargeColumns&, FieldColumns, TileRows,
                           unsigned char* close);

struct PairKernel {
  AddFields add_fields;         ///< to both charges of each pair i < j
  AddFields add_fields_one_way; ///< to the targets only; the two ranges are disjoint
  std::size_t targets;          ///< per tile
};

} // namespace ehdjet::detail
