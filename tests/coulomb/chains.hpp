#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace ehdjet::test {

/// Charges in a test: columns that own their memory.
struct Chain {
  std::vector<double> x, y, z, q;

  explicit Chain(std::size_t n = 0, double charge = 1)
      : x(n)
      , y(n)
      , z(n)
      , q(n, charge) {}
  [[nodiscard]] std::size_t size() const { return q.size(); }
  [[nodiscard]] ConstVec3View r() const { return {x, y, z}; }
  void set(std::size_t i, const Vec3& r) { x[i] = r.x(), y[i] = r.y(), z[i] = r.z(); }
  void add(const Vec3& r, double charge) {
    x.push_back(r.x()), y.push_back(r.y()), z.push_back(r.z()), q.push_back(charge);
  }
};

struct Force {
  std::vector<double> x, y, z;

  explicit Force(std::size_t n)
      : x(n)
      , y(n)
      , z(n) {}
  [[nodiscard]] Vec3View view() { return {x, y, z}; }
  [[nodiscard]] Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  bool operator==(const Force&) const = default;
};

inline Force force_on(const Chain& chain, CoulombSolver& solver) {
  Force force(chain.size());
  solver.add_force({chain.r(), chain.q}, force.view());
  return force;
}

/// Along no axis, so that a wrong sign or a mixed-up component shows.
inline const Vec3 along{1. / 3, 2. / 3, -2. / 3};
inline const Vec3 across = along.unitOrthogonal();
inline const Vec3 upward = along.cross(across);

/// r_i = radius (cos, sin)(i step_angle) around `along`, rising by `rise` per bead.
inline Chain helix(std::size_t n, double radius, double step_angle, double rise) {
  Chain chain(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double k = static_cast<double>(i), angle = k * step_angle;
    chain.set(i, radius * std::cos(angle) * across + radius * std::sin(angle) * upward
                     + k * rise * along);
  }
  return chain;
}

inline Chain straight_chain(std::size_t n, double spacing = 1) {
  return helix(n, 0, 0, spacing);
}

/// A random walk; charges and steps log-uniform over so many decades below 1.
inline Chain random_chain(std::size_t n, double charge_decades, double step_decades,
                          unsigned seed = 1) {
  std::mt19937 bits(seed);
  const auto uniform = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  Chain chain;
  Vec3 r = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double charge = std::pow(10, -charge_decades * uniform());
    chain.add(r, i % 7 == 3 ? -charge : charge);
    const Vec3 u{uniform() - 0.5, uniform() - 0.5, uniform() - 0.3};
    r += std::pow(10, -step_decades * uniform()) * u.normalized();
  }
  return chain;
}

} // namespace ehdjet::test
