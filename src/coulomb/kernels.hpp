#pragma once

#include "ehdjet/coulomb/simd_level.hpp"

#include "expansion_kernel.hpp"
#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// The kernels of one instruction set.
struct Kernels {
  PairKernel pairs;
  ExpansionKernel expansions;
};

/// errors : ContractViolation if this processor does not have the instruction set
Kernels kernels_of(SimdLevel level);

} // namespace ehdjet::detail
