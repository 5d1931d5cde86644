#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <memory>

#include "far_field.hpp"
#include "kernels.hpp"

namespace ehdjet::detail {

/// How a solver keeps its tolerance.
struct ClusterParameters {
  double tolerance = 1e-6;
  ToleranceNorm norm = ToleranceNorm::global;
  int order = 8;
  std::size_t leaf = 32; ///< a multiple of `padding`
  /// Radius over distance to the nearest point of the other ball: never more than this.
  double opening = 0.75;
};

/// A solver that sums far clusters of charges by their expansions.
///
/// A pair of clusters is accepted if the error of its expansions, estimated from the tails of the
/// series, is below the tolerance times the root mean square of the net force (`moving`, `global`)
/// or times the forces of the pair itself (`per_bead`). On a smooth curve forces cancel (their sum
/// of magnitudes is 10 to 1000 times the net force), which a criterion of angles alone would not
/// see. Charges that do not follow a curve are sorted in space first.
std::unique_ptr<CoulombSolver> make_cluster_solver(const Kernels& kernels,
                                                   const ClusterParameters& parameters,
                                                   std::unique_ptr<FarField> far_field);

} // namespace ehdjet::detail
