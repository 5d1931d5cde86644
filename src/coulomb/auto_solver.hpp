#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/coulomb/solver_options.hpp"

#include <memory>

namespace ehdjet::detail {

/// Picks the cheapest solver for each number of charges by a cost model, with hysteresis: a jet
/// whose beads come and go around a crossover does not switch at each of them.
std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options);

} // namespace ehdjet::detail
