#pragma once

#include "ehdjet/coulomb/simd_level.hpp"
#include "ehdjet/coulomb/solver.hpp"

#include <memory>

namespace ehdjet {

/// The O(n^2) sum, each pair computed once (Newton's third law to round-off).
///
/// threads: n below `parallel_from` runs on the calling thread
std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level = best_simd_level());

} // namespace ehdjet
