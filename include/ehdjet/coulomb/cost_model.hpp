#pragma once

#include "ehdjet/coulomb/simd_level.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace ehdjet {

/// The solvers that "auto" chooses from. The treecode is never the cheapest one.
inline constexpr std::array<std::string_view, 2> priced_solvers{"direct", "fmm"};

/// The cost of a force call, as tables over the number of charges and the tolerance. The logarithms
/// are interpolated. Only ratios of costs matter. The fast multipole method has two tables: one for
/// a whipping jet, and one for charges that fill space, where every cluster has more neighbours. For
/// other geometries the cost is interpolated between the two.
struct CostModel {
  std::vector<double> charges{250,  500, 1000, 2000, 4000,
                              8000, 2e4, 6e4,  2e5}; ///< ascending (c)
  std::vector<double> tolerances{1e-12, 1e-10, 1e-8, 1e-6,
                                 1e-5,  1e-4,  1e-3, 1e-2}; ///< ascending (t)
  std::vector<double> direct;                               ///< seconds per call (c)
  /// Seconds per call of the fast multipole method, tolerance after tolerance (t c).
  std::vector<double> jet, cloud;

  /// Outside the tables the cost is extrapolated with the slope at their edge. `crowding`: 0 for a
  /// jet, 1 for charges that fill space.
  /// errors : ContractViolation for a solver that is not in `priced_solvers`
  [[nodiscard]] double cost(std::string_view solver, std::size_t n, double tolerance,
                            double crowding = 0) const;
  [[nodiscard]] std::string_view cheapest(std::size_t n, double tolerance,
                                          double crowding = 0) const;
  /// The smallest number of charges for which the direct sum is not the cheapest solver.
  [[nodiscard]] std::size_t crossover(double tolerance, double crowding = 0) const;

  /// The tables that come with the program. They depend only on the instruction set, so that a
  /// scene gives the same bits on every machine. `ehdjet calibrate` measures other tables.
  static const CostModel& shipped(SimdLevel level = best_simd_level());
  /// Times all priced solvers with the current number of threads. This takes about a minute.
  static CostModel measured(SimdLevel level = best_simd_level());
};

} // namespace ehdjet
