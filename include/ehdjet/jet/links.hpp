#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/jet/bead_range.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Geometry of the links (model 1):
///
///     d_k = r_k - r_(k-1),   l_k = |d_k|,   t_k = d_k / l_k,   k = first ... last
///
/// shapes : every array (beads + 1); entries right before `first` and right behind `last` hold
///          d = 0, l = 1, so that loops over beads may look one link further without asking
/// units  : [m]
/// The upstream neighbour of the first bead that has a link is bead 0, also across an embryo. Of a
/// part of a chain, `first` to `last` are the links that pull at its beads; no other entry is
/// valid.
struct Links {
  std::vector<double> dx, dy, dz, length;
  std::size_t first = 1, last = 0;
  std::size_t head = 1; ///< the link whose upstream neighbour is bead 0
  BeadRange beads = {}; ///< the beads of the part that have a link above them

  /// `first_bead`: the first one below bead 0 with a link.
  void compute(ConstVec3View r, std::size_t first_bead, BeadRange targets = {});
  [[nodiscard]] std::size_t upstream(std::size_t k) const { return k == head ? 0 : k - 1; }
  [[nodiscard]] Vec3 vector(std::size_t k) const { return {dx[k], dy[k], dz[k]}; }
};

} // namespace ehdjet
