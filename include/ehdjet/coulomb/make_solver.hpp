#pragma once

#include "ehdjet/coulomb/solver.hpp"

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

/// errors : a name that is not in `coulomb_solvers()` is an InputError
std::unique_ptr<CoulombSolver> make_coulomb_solver(std::string_view name);

} // namespace ehdjet
