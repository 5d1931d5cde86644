#pragma once

namespace ehdjet {

/// What a uniformly charged thread has within one link and beads at its ends do not, for a link of unit
/// length: the energy of the thread less that of its beads (model 3.1). eta = a/l.
///
/// laws : e = eta dd/deta,  f = eta de/deta
struct SubGrid {
  double d = 0, e = 0, f = 0;
};

/// For point beads: d = ln(2/eta) - gamma, e = -1, f = 0.
[[nodiscard]] SubGrid sub_grid_of_points(double eta);

/// For beads whose pairs are softened by eta (`SoftenedPairs`):
///
///     d = asinh(X/eta) - sum_(p=1..N) (p^2 + eta^2)^(-1/2),   X = N + 1/2,   N -> infinity
///
/// computed as a power series for eta <= 1/2, else as a series of Bessel functions.
[[nodiscard]] SubGrid sub_grid_of_softened(double eta);

} // namespace ehdjet
