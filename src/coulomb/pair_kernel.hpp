#pragma once

#include <cstddef>

namespace ehdjet::detail {

/// Point charges as the kernels want them: 64-byte aligned columns, scaled by powers of two
/// and padded, so that the inner loop needs neither a range check nor a remainder.
///
///     |x|, |y|, |z| < 2^57,  |q| < 1;  padding: q = 0, at x = 2^58, 2 2^58, 3 2^58, ...
///
/// Then r^2 < 2^126 never overflows single precision, in which r^-1 is first estimated.
struct ChargeColumns {
  const double *x, *y, *z, *q;
};
inline constexpr int coordinate_exponent = 57;
inline constexpr double padding_distance = 0x1p58;
inline constexpr std::size_t padding = 8; ///< columns are a multiple of this long

/// A pair is *close* if max(|dx|, |dy|, |dz|) < close_distance, a test free of rounding. The
/// kernels skip close pairs (r^2 might be subnormal in single precision) and report that they have
/// met one.
inline constexpr double close_distance = 0x1p-60;

struct FieldColumns {
  double *x, *y, *z;
};

/// Tiles first, first + stride, ... below last of consecutive targets, against the sources in
/// [begin, end): multiples of `padding`. Only pairs i < j are visited.
struct TileRows {
  std::size_t first, last, stride, begin, end;
};

/// Adds the field  sum_j q_j (r_i - r_j)/|r_i - r_j|^3  of every visited pair to both of its
/// members. Sets close[t] if tile t of targets has met a close pair; never clears it.
using AddFields = void (*)(const ChargeColumns&, FieldColumns, TileRows,
                           unsigned char* close);

struct PairKernel {
  AddFields add_fields;
  /// The field of the sources on the targets only; the two ranges are disjoint, in any order.
  AddFields add_fields_one_way;
  std::size_t targets; ///< per tile
};

PairKernel portable_pair_kernel();
PairKernel avx2_pair_kernel();
PairKernel avx512_pair_kernel();

} // namespace ehdjet::detail
