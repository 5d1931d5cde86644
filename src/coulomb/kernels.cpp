#include "kernels.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/simd_level.hpp"

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
  constexpr std::array<std::string_view, 3> names{"portable", "avx2", "avx512"};
  return names[static_cast<std::size_t>(level)];
}

detail::Kernels detail::kernels_of(SimdLevel level) {
  EHDJET_EXPECTS(level <= best_simd_level());
#if defined(__x86_64__)
  if (level == SimdLevel::avx512) return avx512_kernels();
  if (level == SimdLevel::avx2) return avx2_kernels();
#endif
  return portable_kernels();
}

} // namespace ehdjet
