#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/jet/links.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// F_k += T_(k+1) t_(k+1) - T_k t_k: a tension along every link pulls its two ends together.
///
/// shapes : `tension_per_length` = T_k/l_k [N/m], as long as links.length, valid for
///          links.first ... links.last, and 0 at the entry behind
inline void add_link_tension(const Links& links, std::span<const double> tension_per_length,
                             BeadRange targets, Vec3View force) {
  const double *t = tension_per_length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data();
  double *fx = force.x.data(), *fy = force.y.data(), *fz = force.z.data();
  if (const std::size_t k = links.head; targets.begin == 0)
    fx[0] += t[k] * dx[k], fy[0] += t[k] * dy[k], fz[0] += t[k] * dz[k];
  for_parts(links.beads.begin, links.beads.end, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) {
      fx[k] += t[k + 1] * dx[k + 1] - t[k] * dx[k];
      fy[k] += t[k + 1] * dy[k + 1] - t[k] * dy[k];
      fz[k] += t[k + 1] * dz[k + 1] - t[k] * dz[k];
    }
  });
}

/// Room for a value per link, with the zero that loops behind the last link meet.
inline double* per_link(const Links& links, std::vector<double>& values) {
  values.resize(links.length.size());
  values[links.last + 1] = 0;
  return values.data();
}

} // namespace ehdjet
