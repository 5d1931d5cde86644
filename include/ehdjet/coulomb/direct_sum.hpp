#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <memory>
#include <string_view>

namespace ehdjet {

/// Instruction sets the pair kernel is compiled for; `best_simd_level()` picks one at run time.
enum class SimdLevel { portable, avx2, avx512 };

[[nodiscard]] SimdLevel best_simd_level(); ///< widest level this processor has
[[nodiscard]] std::string_view name_of(SimdLevel level); ///< "portable", "avx2", "avx512"

/// The O(n^2) sum, each pair computed once (Newton's third law to round-off).
///
/// threads: n below `parallel_from` runs on the calling thread
std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level = best_simd_level());

} // namespace ehdjet
