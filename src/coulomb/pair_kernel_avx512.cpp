#include <immintrin.h>

#include "expansions.hpp"

namespace ehdjet::detail {
namespace {

/// The relative error of `vrsqrt14pd` is below 2^-14 for all doubles, so that |e| < 2^-13.
struct Avx512 {
  typedef double Vector __attribute__((vector_size(64)));
  typedef long long Mask __attribute__((vector_size(64)));
  // With this shape of the tile all values stay in registers.
  static constexpr int lanes = 8, targets = 2, vectors = 2, degree = 3;

  // A full mask gives the same instructions. For the plain forms GCC 12 warns of an uninitialised
  // value (GCC bug 105593).
  static constexpr __mmask8 all = 0xff;

  static Vector inverse_sqrt(Vector r2) { return _mm512_maskz_rsqrt14_pd(all, r2); }
  static Vector smaller(Vector a, Vector b) { return _mm512_maskz_min_pd(all, a, b); }
  static bool any_below(Vector a, double bound) {
    return _mm512_cmp_pd_mask(a, _mm512_set1_pd(bound), _CMP_LT_OQ) != 0;
  }
};

} // namespace

Kernels avx512_kernels() {
  return {pair_kernel<Avx512>(), expansion_kernel<Avx512>()};
}

} // namespace ehdjet::detail
