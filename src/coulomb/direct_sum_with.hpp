#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <memory>

#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// The direct sum on a given kernel: `make_direct_sum` chooses one, tests bring their own.
std::unique_ptr<CoulombSolver> make_direct_sum_with(PairKernel kernel);

} // namespace ehdjet::detail
