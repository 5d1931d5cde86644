#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <span>

#include "cluster_solver.hpp"

namespace ehdjet::detail {

/// Energy of charges [J], as a treecode: the charges of each leaf in the potentials of far clusters'
/// multipoles. A cluster is far if the tail of its series is below the tolerance relative to its
/// potential: the energies of pairs of like charges do not cancel.
double cluster_energy(const Kernels& kernels, const ClusterParameters& parameters,
                      ConstVec3View r, std::span<const double> q);

} // namespace ehdjet::detail
