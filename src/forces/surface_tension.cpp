#include "ehdjet/forces/surface_tension.hpp"

#include "ehdjet/core/parallel.hpp"
#include "ehdjet/jet/curvature.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "link_tension.hpp"

namespace ehdjet {
void BendingSurfaceTension::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data(), *v = stage.volume.data();
  radius_.resize(links.length.size());
  double *a = radius_.data(), *fx = force.x.data(), *fy = force.y.data(),
         *fz = force.z.data();
  for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k)
      a[k] = std::sqrt(v[k] / (std::numbers::pi * l[k]));
  });

  const double alpha = coefficient_;
  const std::size_t last = std::min(links.beads.end, stage.beads() - 1);
  for_parts(links.beads.begin, last, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) {
      const Curvature c =
          curvature(-dx[k], -dy[k], -dz[k], dx[k + 1], dy[k + 1], dz[k + 1]);
      const double mean_radius = (a[k] + a[k + 1]) / 2;
      const double strength = alpha * std::numbers::pi * mean_radius * mean_radius;
      fx[k] += strength * c.x, fy[k] += strength * c.y, fz[k] += strength * c.z;
    }
  });
}

TermAccount BendingSurfaceTension::account() const {
  return {.channel = {.name = "surface",
                      .energy = "surface_work",
                      .energy_meaning =
                          "work so far of the paper's surface tension, which has "
                          "no energy",
                      .momentum = "surface_impulse",
                      .momentum_meaning = "so far, of the paper's surface tension"}};
}

// On a nearly straight chain K = 2/(l_k + l_(k+1)) (t_(k+1) - t_k), and dt/dd = (I - t t^T)/l.
void BendingSurfaceTension::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  const auto radius = [&](std::size_t k) {
    return std::sqrt(stage.volume[k] / (std::numbers::pi * links.length[k]));
  };
  const auto across = [&](std::size_t k) -> Mat3 {
    const Vec3 t = links.vector(k) / links.length[k];
    return (Mat3::Identity() - t * t.transpose()) / links.length[k];
  };
  for (std::size_t k = links.first; k < links.last; ++k) {
    const double mean_radius = (radius(k) + radius(k + 1)) / 2;
    const double strength = coefficient_ * std::numbers::pi * mean_radius * mean_radius * 2
                            / (links.length[k] + links.length[k + 1]);
    out.pull_lower[k] += strength * across(k);
    out.pull_upper[k + 1] += strength * across(k + 1);
  }
}

void LineSurfaceTension::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data();
  double* t = per_link(links, tension_per_length_);
  const double alpha = coefficient_;
  for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) // pi a alpha / l
      t[k] = alpha * std::sqrt(std::numbers::pi * v[k] / l[k]) / l[k];
  });
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

TermAccount LineSurfaceTension::account() const {
  return {.energy = "surface_energy", .energy_meaning = "sum 2 alpha sqrt(pi V l)"};
}

double LineSurfaceTension::energy(const Stage& stage) {
  const Links& links = stage.links();
  double energy = 0;
  for (std::size_t k = links.first; k <= links.last; ++k)
    energy +=
        2 * coefficient_ * std::sqrt(std::numbers::pi * stage.volume[k] * links.length[k]);
  return energy;
}

double LineSurfaceTension::feeding_power(const Stage& stage, const LinkContent& rate) {
  const double l = stage.links().length[1];
  return coefficient_ * std::sqrt(std::numbers::pi * l / stage.volume[1]) * rate.volume;
}

void LineSurfaceTension::add_tension(const Stage& stage, std::span<double> tension) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] +=
        coefficient_ * std::sqrt(std::numbers::pi * stage.volume[k] / links.length[k]);
}

// With F = alpha sqrt(pi V) d l^(-3/2): dF/dd = alpha sqrt(pi V) l^(-3/2) (I - 3/2 t t^T).
void LineSurfaceTension::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const double l = links.length[k];
    const Vec3 t = links.vector(k) / l;
    const double pull =
        coefficient_ * std::sqrt(std::numbers::pi * stage.volume[k] / l) / l;
    out.add_pull(k, pull * (Mat3::Identity() - 1.5 * t * t.transpose()));
  }
}

} // namespace ehdjet
