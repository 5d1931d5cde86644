#include <immintrin.h>

#include "expansions.hpp"
#include "pair_tiles.hpp"

namespace ehdjet::detail {
namespace {

/// `vrsqrtps`: relative error below 1.5 2^-12, so |e| < 7.4e-4. The root and the division that
/// it replaces take as long as the whole tile on processors with one slow divider.
struct Avx2 {
  typedef double Vector __attribute__((vector_size(32)));
  typedef long long Mask __attribute__((vector_size(32)));
  static constexpr int lanes = 4, targets = 2, vectors = 4,
                       degree = 4; // shape: fastest of 12

  static Vector inverse_sqrt(Vector r2) {
    return _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(r2)));
  }
  static Vector smaller(Vector a, Vector b) { return _mm256_min_pd(a, b); }
  static bool any_below(Vector a, double bound) {
    return _mm256_movemask_pd(_mm256_cmp_pd(a, _mm256_set1_pd(bound), _CMP_LT_OQ)) != 0;
  }
};

} // namespace

PairKernel avx2_pair_kernel() {
  return pair_kernel<Avx2>();
}

ExpansionKernel avx2_expansion_kernel() {
  return expansion_kernel<Avx2>();
}

} // namespace ehdjet::detail
