#include <immintrin.h>

#include "expansions.hpp"

namespace ehdjet::detail {
namespace {

/// The relative error of `vrsqrtps` is below 1.5 2^-12, so that |e| < 7.4e-4. On processors with a
/// single slow divider, an exact root and division would take as long as the rest of the tile.
struct Avx2 {
  typedef double Vector __attribute__((vector_size(32)));
  typedef long long Mask __attribute__((vector_size(32)));
  // This shape of the tile was the fastest of twelve.
  static constexpr int lanes = 4, targets = 2, vectors = 4, degree = 4;

  static Vector inverse_sqrt(Vector r2) {
    return _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(r2)));
  }
  static Vector smaller(Vector a, Vector b) { return _mm256_min_pd(a, b); }
  static bool any_below(Vector a, double bound) {
    return _mm256_movemask_pd(_mm256_cmp_pd(a, _mm256_set1_pd(bound), _CMP_LT_OQ)) != 0;
  }
};

} // namespace

Kernels avx2_kernels() {
  return {pair_kernel<Avx2>(), expansion_kernel<Avx2>()};
}

} // namespace ehdjet::detail
