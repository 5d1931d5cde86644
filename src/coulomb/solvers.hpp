#pragma once

#include "ehdjet/coulomb/make_solver.hpp"

#include <cstddef>
#include <memory>
#include <span>

#include "far_field.hpp"
#include "kernels.hpp"

namespace ehdjet::detail {

/// The direct sum with a given kernel. `make_direct_sum` chooses one; tests use their own.
std::unique_ptr<CoulombSolver> make_direct_sum_with(PairKernel kernel);

struct ClusterParameters {
  double tolerance = 1e-6;
  ToleranceNorm norm = ToleranceNorm::global;
  int order = 8;
  std::size_t leaf = 32; ///< a multiple of `padding`
  /// Largest allowed ratio of a cluster's radius to its distance from the nearest point of the
  /// other cluster's ball.
  double opening = 0.75;
};

/// A solver that sums distant clusters of charges by their expansions.
///
/// The error of the expansions of a pair of clusters is estimated from the tails of the series. The
/// pair is accepted if this error is below the tolerance times the root mean square of the net
/// force (`moving`, `global`), or times the force of the pair itself (`per_bead`). On a smooth curve
/// the forces cancel: the sum of their magnitudes is 10 to 1000 times the net force. A criterion of
/// angles alone would not take this into account. Charges that do not follow a curve are first
/// sorted in space.
std::unique_ptr<CoulombSolver> make_cluster_solver(const Kernels& kernels,
                                                   const ClusterParameters& parameters,
                                                   std::unique_ptr<FarField> far_field);

/// Energy of charges [J], computed like a treecode: each leaf in the potentials of the multipoles of
/// distant clusters. A cluster is distant if the tail of its series is below the tolerance relative
/// to its potential. This suffices, because the energies of pairs of like charges do not cancel.
double cluster_energy(const Kernels& kernels, const ClusterParameters& parameters,
                      ConstVec3View r, std::span<const double> q);

/// The cheaper of the direct sum and the fast multipole method. The cost model depends on the
/// number of charges and on how crowded they are. Switching has a hysteresis: if the number of
/// charges fluctuates around a crossover, the solver does not switch each time.
std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options);

/// Compares the force with a direct sum on sampled charges once in `every` calls. If the error
/// exceeds the tolerance, the solver becomes stricter.
std::unique_ptr<CoulombSolver> make_checked_solver(std::unique_ptr<CoulombSolver> solver,
                                                   std::size_t every);

} // namespace ehdjet::detail
