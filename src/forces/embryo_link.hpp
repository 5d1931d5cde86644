#pragma once

#include "ehdjet/jet/nozzle.hpp"
#include "ehdjet/jet/stage.hpp"

namespace ehdjet {

/// df/dt of an embryo's share of its charge while link 2 stretches behind it (model 4.1) [1/s].
inline double charge_fraction_rate(const Embryo& embryo, const Stage& stage) {
  const auto v = stage.columns.velocity();
  Vec3 stretching = v[2] - v[0];
  stretching.x() = v.x[2]; // the nozzle stays at x = 0, the fluid in it moves
  const Links& links = stage.links();
  const double l = links.length[2];
  return embryo.charge_fraction_slope(l) * stretching.dot(links.vector(2)) / l;
}

} // namespace ehdjet
