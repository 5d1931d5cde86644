#pragma once

#include <array>
#include <string_view>

namespace ehdjet {

/// The instruction sets for which kernels are compiled.
enum class SimdLevel { portable, avx2, avx512 };
inline constexpr std::array simd_levels{SimdLevel::portable, SimdLevel::avx2,
                                        SimdLevel::avx512};

[[nodiscard]] SimdLevel best_simd_level(); ///< the widest level that this processor has
[[nodiscard]] std::string_view name_of(SimdLevel level); ///< "portable", "avx2", "avx512"

} // namespace ehdjet
