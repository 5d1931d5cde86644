#pragma once

#include "ehdjet/coulomb/cost_model.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace ehdjet {

/// What a tolerance is relative to.
enum class ToleranceNorm {
  global,  ///< |dF|_2 <= tolerance |F|_2 over all charges
  per_bead ///< |dF_i| <= tolerance sum_j |f_ij| for every charge
};

/// Which solver, and how exact it has to be. The user gives a tolerance; order, acceptance and leaf size follow
/// from it unless a study sets them.
struct SolverOptions {
  std::string solver = "direct";
  double tolerance = 1e-6; ///< of "auto", "treecode" and "fmm" [-]
  ToleranceNorm norm = ToleranceNorm::global;

  std::optional<int> order = {}; ///< of the expansions
  std::optional<double> opening =
      {}; ///< largest radius over distance of an accepted cluster, theta
  std::optional<std::size_t> leaf =
      {}; ///< charges per leaf of the cluster tree, a multiple of 8

  std::optional<CostModel> costs = {}; ///< what "auto" goes by; the shipped one if absent
  /// Every so-manieth call is compared with the direct sum on sampled charges; absent: none.
  std::optional<std::size_t> check_every = {};
};

} // namespace ehdjet
