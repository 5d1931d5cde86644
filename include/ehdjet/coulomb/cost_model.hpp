#pragma once

#include "ehdjet/coulomb/simd_level.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace ehdjet {

/// Solvers that "auto" chooses from. The treecode is never the cheapest one.
inline constexpr std::array<std::string_view, 2> priced_solvers{"direct", "fmm"};

/// What a force call costs, as tables over the number of charges and the tolerance that are read by
/// interpolation of logarithms. Only ratios matter. The fast multipole method has one for the
/// geometry of a whipping jet and one for charges that fill space, where every cluster has more
/// neighbours; what is between them is interpolated.
struct CostModel {
  std::vector<double> charges;    ///< ascending (c)
  std::vector<double> tolerances; ///< ascending (t)
  std::vector<double> direct;     ///< seconds per call (c)
  std::vector<double> jet,
      cloud; ///< of the fast multipole method, tolerance after tolerance (t c)

  /// Beyond the tables their edges are continued with their slope. `crowding`: 0 a jet, 1 charges
  /// that fill space.
  /// errors : ContractViolation for a solver that is not priced
  [[nodiscard]] double cost(std::string_view solver, std::size_t n, double tolerance,
                            double crowding = 0) const;
  [[nodiscard]] std::string_view cheapest(std::size_t n, double tolerance,
                                          double crowding = 0) const;
  /// Number of charges from which on the direct sum is not the cheapest any more.
  [[nodiscard]] std::size_t crossover(double tolerance, double crowding = 0) const;

  /// Constants that come with the program, per instruction set: the same everywhere, so that a
  /// scene has the same bits wherever the kernels have them. `ehdjet calibrate` measures others.
  static const CostModel& shipped(SimdLevel level = best_simd_level());
  /// Times all priced solvers on this machine, with the present number of threads: a minute.
  static CostModel measured(SimdLevel level = best_simd_level());
};

} // namespace ehdjet
