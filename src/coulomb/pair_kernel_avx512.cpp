#include <immintrin.h>

#include "expansions.hpp"
#include "pair_tiles.hpp"

namespace ehdjet::detail {
namespace {

/// `vrsqrt14pd`: relative error below 2^-14, so |e| < 2^-13, over the whole double range.
struct Avx512 {
  typedef double Vector __attribute__((vector_size(64)));
  typedef long long Mask __attribute__((vector_size(64)));
  static constexpr int lanes = 8, targets = 2, vectors = 2, degree = 3; // no spills

  // The forms with a full mask are the same instructions; GCC 12 takes the plain ones for uses
  // of an uninitialised value (GCC bug 105593).
  static constexpr __mmask8 all = 0xff;

  static Vector inverse_sqrt(Vector r2) { return _mm512_maskz_rsqrt14_pd(all, r2); }
  static Vector smaller(Vector a, Vector b) { return _mm512_maskz_min_pd(all, a, b); }
  static bool any_below(Vector a, double bound) {
    return _mm512_cmp_pd_mask(a, _mm512_set1_pd(bound), _CMP_LT_OQ) != 0;
  }
};

} // namespace

PairKernel avx512_pair_kernel() {
  return pair_kernel<Avx512>();
}

ExpansionKernel avx512_expansion_kernel() {
  return expansion_kernel<Avx512>();
}

} // namespace ehdjet::detail
