#pragma once

#include "ehdjet/core/columns.hpp"

#include <span>

namespace ehdjet {

/// U_C = sum over pairs of q_i q_j / (4 pi eps0 |r_i - r_j|), all pairs one by one [J].
///
/// shapes : r (n), q (n), [m], [C]. Coincident pairs are skipped, as in the forces.
/// laws   : the same bits for any number of threads
double coulomb_energy(ConstVec3View r, std::span<const double> q);

} // namespace ehdjet
