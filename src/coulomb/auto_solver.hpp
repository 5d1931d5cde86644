#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/coulomb/solver_options.hpp"

#include <memory>

namespace ehdjet::detail {

/// Direct sum or fast multipole method, whichever is cheaper by a cost model for the number of
/// charges and for how crowded they are, with hysteresis: a jet whose beads come and go around a
/// crossover does not switch at each of them.
std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options);

} // namespace ehdjet::detail
