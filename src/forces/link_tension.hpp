#pragma once

#include "ehdjet/core/columns.hpp"
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
  const double* t = tension_per_length.data();
  const auto component = [&](const double* d, double* f) {
    if (targets.begin == 0) f[0] += t[links.head] * d[links.head];
#pragma omp simd
    for (std::size_t k = links.beads.begin; k < links.beads.end; ++k)
      f[k] += t[k + 1] * d[k + 1] - t[k] * d[k];
  };
  component(links.dx.data(), force.x.data());
  component(links.dy.data(), force.y.data());
  component(links.dz.data(), force.z.data());
}

/// Room for a value per link, with the zero that loops behind the last link meet.
inline double* per_link(const Links& links, std::vector<double>& values) {
  values.resize(links.length.size());
  values[links.last + 1] = 0;
  return values.data();
}

} // namespace ehdjet
