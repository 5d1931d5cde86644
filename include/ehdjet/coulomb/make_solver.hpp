#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/coulomb/solver_options.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace ehdjet {

struct SolverDescription {
  std::string_view name;        ///< as in a scene
  std::string_view description; ///< one line
};

/// Every solver there is, for help texts and for tests of what they have in common.
[[nodiscard]] std::span<const SolverDescription> coulomb_solvers();

/// errors : InputError for a name that is not in `coulomb_solvers()`, for a tolerance that the
///          solver cannot keep, and for an order, opening or leaf out of range
std::unique_ptr<CoulombSolver> make_coulomb_solver(const SolverOptions& options);
/// With the default tolerance.
std::unique_ptr<CoulombSolver> make_coulomb_solver(std::string_view name);

} // namespace ehdjet
