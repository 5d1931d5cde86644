#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <memory>

namespace ehdjet::detail {

/// Every so many calls compares the force with a direct sum on sampled charges, and makes the
/// solver stricter when that exceeds its tolerance.
std::unique_ptr<CoulombSolver> make_checked_solver(std::unique_ptr<CoulombSolver> solver,
                                                   std::size_t every);

} // namespace ehdjet::detail
