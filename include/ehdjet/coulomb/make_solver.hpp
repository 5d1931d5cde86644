#pragma once

#include "ehdjet/coulomb/cost_model.hpp"
#include "ehdjet/coulomb/simd_level.hpp"
#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ehdjet {

/// The choice of a solver and its tolerance. The order, opening and leaf size follow from the
/// tolerance unless they are set explicitly.
struct SolverOptions {
  std::string solver = "direct";
  double tolerance = 1e-6; ///< of "auto", "treecode" and "fmm" [-]
  ToleranceNorm norm = ToleranceNorm::global;

  std::optional<int> order = {};        ///< of the expansions
  std::optional<double> opening = {};   ///< theta: largest accepted radius over distance
  std::optional<std::size_t> leaf = {}; ///< charges per leaf, a multiple of 8
  std::optional<CostModel> costs = {};  ///< used by "auto"; by default CostModel::shipped
  /// One in so many calls is compared with the direct sum on sampled charges; by default none.
  std::optional<std::size_t> check_every = {};
  SimdLevel simd = best_simd_level();
};

struct SolverDescription {
  std::string_view name;        ///< as in a scene
  std::string_view description; ///< one line
  std::unique_ptr<CoulombSolver> (*make)(const SolverOptions&);
};

/// All solvers, for help texts and for tests of their common properties.
[[nodiscard]] std::span<const SolverDescription> coulomb_solvers();

/// errors : InputError for a name that is not in `coulomb_solvers()`, for a tolerance that the
///          solver cannot keep, and for an order, opening or leaf out of range
std::unique_ptr<CoulombSolver> make_coulomb_solver(const SolverOptions& options);
/// The O(n^2) sum, which computes each pair once and obeys Newton's third law to round-off.
/// errors : ContractViolation if this processor does not have the instruction set
std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level = best_simd_level());

} // namespace ehdjet
