#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/jet/stage.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace ehdjet {

/// Whether fluid flows into that link all the time (model 4.3).
inline bool is_fed(const Stage& stage, std::size_t k) {
  return stage.feed != nullptr && k == 1;
}

/// How the fluid in a link moves.
struct LinkMotion {
  Vec3 velocity;          ///< w of its lower end relative to its upper one [m/s]
  double strain_rate = 0; ///< e [1/s]
};

/// e = w.d/l^2 (model 2). A landed bead keeps the velocity of its impact as a record, but it
/// moves with the plate. The upper end of a fed link moves at Q/A_1 relative to the nozzle, which stays in its plane:
/// e = w.d/l^2 - Q/V_1 (model 4.3).
///
/// A bead that has passed the collector in this step flies on with its velocity. A stress that has no memory
/// would jump at the end of the step, where the bead rests; with `passed_rest` it rests already.
inline LinkMotion motion_of(const Stage& stage, std::size_t k, bool passed_rest = false) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  const auto velocity = [&](std::size_t bead) -> Vec3 {
    if (!stage.landed.empty()
        && std::ranges::binary_search(stage.landed, bead, {}, &LandedBead::bead))
      return stage.plate_velocity;
    if (passed_rest && !stage.absorbed.empty()
        && std::ranges::binary_search(stage.absorbed, bead, std::greater{}))
      return stage.plate_velocity;
    return v[bead];
  };
  const std::size_t up = links.upstream(k);
  LinkMotion motion{.velocity = velocity(k) - velocity(up)};
  if (is_fed(stage, k)) motion.velocity.x() = velocity(k).x();
  const double l = links.length[k];
  motion.strain_rate = motion.velocity.dot(links.vector(k)) / (l * l);
  if (is_fed(stage, k)) motion.strain_rate -= stage.feed->flow_rate / stage.volume[k];
  return motion;
}
inline double strain_rate(const Stage& stage, std::size_t k, bool passed_rest = false) {
  return motion_of(stage, k, passed_rest).strain_rate;
}

/// e of the links links.first ... links.last [1/s]. `values` gets room for a value per link.
inline const double* strain_rates(const Stage& stage, std::vector<double>& values,
                                  bool passed_rest = false) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  values.resize(links.length.size());
  double* e = values.data();
  const double *l = links.length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data(), *vx = v.x.data(), *vy = v.y.data(), *vz = v.z.data();
  std::size_t begin = links.first;
  if (begin == links.head && begin <= links.last)
    e[begin] = strain_rate(stage, begin), ++begin;
  for_parts(begin, links.last + 1, [=](std::size_t from, std::size_t to) {
#pragma omp simd
    for (std::size_t k = from; k < to; ++k)
      e[k] = ((vx[k] - vx[k - 1]) * dx[k] + (vy[k] - vy[k - 1]) * dy[k]
              + (vz[k] - vz[k - 1]) * dz[k])
             / (l[k] * l[k]);
  });
  for (const LandedBead& b : stage.landed)
    for (const std::size_t k : {b.bead, b.bead + 1})
      if (k >= links.first && k <= links.last) e[k] = strain_rate(stage, k);
  if (passed_rest)
    for (const std::size_t bead : stage.absorbed)
      for (const std::size_t k : {bead, bead + 1})
        if (k >= links.first && k <= links.last) e[k] = strain_rate(stage, k, true);
  return e;
}

} // namespace ehdjet
