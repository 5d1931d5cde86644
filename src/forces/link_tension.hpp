#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/jet/links.hpp"

#include <cstddef>
#include <span>

namespace ehdjet {

/// F_k += T_(k+1) t_(k+1) - T_k t_k: a tension along every link pulls its two ends together.
///
/// shapes : `tension_per_length` = T_k/l_k [N/m], as long as links.length, zero outside the links
inline void add_link_tension(const Links& links, std::span<const double> tension_per_length,
                             Vec3View force) {
  const double* t = tension_per_length.data();
  const auto component = [&](const double* d, double* f) {
    f[0] += t[links.first] * d[links.first]; // the upstream end of the first link
#pragma omp simd
    for (std::size_t k = links.first; k <= links.last; ++k)
      f[k] += t[k + 1] * d[k + 1] - t[k] * d[k];
  };
  component(links.dx.data(), force.x.data());
  component(links.dy.data(), force.y.data());
  component(links.dz.data(), force.z.data());
}

} // namespace ehdjet
