#pragma once

#include "ehdjet/coulomb/simd_level.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace ehdjet {

/// Solvers that "auto" chooses from, in the order in which a cost model lists them.
inline constexpr std::array<std::string_view, 3> priced_solvers{"direct", "treecode",
                                                                "fmm"};

/// What a force call costs, measured on the geometry of a whipping jet: a table over the number of
/// charges and the tolerance, read by interpolation of logarithms. Only ratios matter.
struct CostModel {
  std::vector<double> charges;    ///< ascending (c)
  std::vector<double> tolerances; ///< ascending (t)
  /// Seconds per call of each solver, (t * c), tolerance after tolerance.
  std::array<std::vector<double>, priced_solvers.size()> seconds = {};

  /// Beyond the table its edges are continued with their slope.
  /// errors : ContractViolation for a solver that is not priced
  [[nodiscard]] double cost(std::string_view solver, std::size_t n, double tolerance) const;
  [[nodiscard]] std::string_view cheapest(std::size_t n, double tolerance) const;
  /// Number of charges from which on the direct sum is not the cheapest any more.
  [[nodiscard]] std::size_t crossover(double tolerance) const;

  /// Constants that come with the program, per instruction set: the same everywhere, so that a
  /// scene has the same bits wherever the kernels have them. `ehdjet calibrate` measures others.
  static const CostModel& shipped(SimdLevel level = best_simd_level());
  /// Times all priced solvers on this machine, with the present number of threads: half a minute.
  static CostModel measured(SimdLevel level = best_simd_level());
};

} // namespace ehdjet
