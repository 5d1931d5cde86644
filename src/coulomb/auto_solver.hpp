#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/coulomb/solver_options.hpp"

#include <memory>

namespace ehdjet::detail {

/// Picks the cheapest solver for each number of charges by a cost model, with hysteresis: a jet whose
/// beads come and go around a crossover does not switch at each of them.
std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options);

/// Compares the force of every so-manieth call with a direct sum on sampled charges, and makes the
/// solver stricter when that exceeds its tolerance.
std::unique_ptr<CoulombSolver> make_checked_solver(std::unique_ptr<CoulombSolver> solver,
                                                   std::size_t every);

} // namespace ehdjet::detail
