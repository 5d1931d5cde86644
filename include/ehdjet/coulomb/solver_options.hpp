#pragma once

#include "ehdjet/coulomb/cost_model.hpp"
#include "ehdjet/coulomb/simd_level.hpp"
#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace ehdjet {

/// Which solver, and how exact it has to be. The user gives a tolerance; order, acceptance and
/// leaf size follow from it unless a study sets them.
struct SolverOptions {
  std::string solver = "direct";
  double tolerance = 1e-6; ///< of "auto", "treecode" and "fmm" [-]
  ToleranceNorm norm = ToleranceNorm::global;

  std::optional<int> order = {}; ///< of the expansions
  /// Largest radius over distance of an accepted cluster, theta.
  std::optional<double> opening = {};
  /// Charges per leaf of the cluster tree, a multiple of 8.
  std::optional<std::size_t> leaf = {};

  std::optional<CostModel> costs = {}; ///< what "auto" goes by; the shipped one if absent
  /// Every so many calls one is compared with the direct sum on sampled charges; absent: none.
  std::optional<std::size_t> check_every = {};
  SimdLevel simd = best_simd_level();
};

} // namespace ehdjet
