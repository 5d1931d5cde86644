#include "kernels.hpp"

#include "ehdjet/core/error.hpp"

namespace ehdjet {

SimdLevel best_simd_level() {
#if defined(__x86_64__)
  const bool fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
      && __builtin_cpu_supports("avx512vl"))
    return SimdLevel::avx512;
  if (fma) return SimdLevel::avx2;
#endif
  return SimdLevel::portable;
}

std::string_view name_of(SimdLevel level) {
  switch (level) {
  case SimdLevel::avx512:
    return "avx512";
  case SimdLevel::avx2:
    return "avx2";
  case SimdLevel::portable:
    break;
  }
  return "portable";
}

detail::Kernels detail::kernels_of(SimdLevel level) {
  EHDJET_EXPECTS(level <= best_simd_level());
#if defined(__x86_64__)
  if (level == SimdLevel::avx512) return {avx512_pair_kernel(), avx512_expansion_kernel()};
  if (level == SimdLevel::avx2) return {avx2_pair_kernel(), avx2_expansion_kernel()};
#endif
  return {portable_pair_kernel(), portable_expansion_kernel()};
}

} // namespace ehdjet
