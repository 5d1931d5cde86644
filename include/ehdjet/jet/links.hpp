#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Geometry of the links (model 1):
///
///     d_k = r_k - r_(k-1),   l_k = |d_k|,   t_k = d_k / l_k,   k = first ... n
///
/// shapes : every array (beads + 1); entries below `first` and entry n + 1 hold d = 0, l = 1, so
///          that loops over beads may look one link further without asking
/// units  : [m]
/// The upstream neighbour of bead `first` is bead 0, also across an embryo.
struct Links {
  std::vector<double> dx, dy, dz, length;
  std::size_t first = 1, last = 0;

  void compute(ConstVec3View r, std::size_t first_bead);
};

} // namespace ehdjet
