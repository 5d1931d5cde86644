#pragma once

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "support/stress.hpp"

/// Jets to be cut anew.
namespace ehdjet::test {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Along no axis, so that a wrong sign or a mixed-up component shows.
inline const Vec3 along{1. / 3, 2. / 3, -2. / 3};

inline double real(std::size_t k) {
  return static_cast<double>(k);
}

/// Beads at these places; all else differs from bead to bead and from column to column.
inline JetState jet_through(const std::vector<Vec3>& places) {
  const std::size_t n = places.size();
  JetState jet;
  jet.time = 0.125;
  jet.mass.resize(n), jet.charge.resize(n), jet.volume.resize(n);
  jet.table = table_with_stress();
  jet.y.resize(7 * n);
  const auto c = jet.columns();
  for (std::size_t i = 0; i < n; ++i) {
    const double k = real(i);
    c.position().set(i, places[i]);
    c.velocity().set(i, {5 + std::sin(k), std::cos(1.3 * k), 2 * std::sin(0.7 * k)});
    stress_of(c)[i] = 100 * (2 + std::sin(1.1 * k));
    jet.volume[i] = 1 + 0.5 * std::sin(1.7 * k);
    jet.mass[i] = 2 + 0.8 * std::sin(2.3 * k + 1);
    jet.charge[i] = 3 + 0.9 * std::sin(0.9 * k + 2);
  }
  return jet;
}

/// A straight jet with these links.
inline JetState straight_jet(std::span<const double> links) {
  std::vector<Vec3> places{Vec3::Zero()};
  double x = 0;
  for (const double l : links) places.emplace_back((x += l) * along);
  return jet_through(places);
}
inline JetState straight_jet(std::size_t links, double length) {
  return straight_jet(std::vector<double>(links, length));
}

/// Forty links 0.02 x 1.15^i.
inline JetState growing_jet() {
  std::vector<double> links;
  for (std::size_t i = 0; i < 40; ++i) links.push_back(0.02 * std::pow(1.15, i));
  return straight_jet(links);
}

/// Two turns of this helix.
inline Vec3 on_helix(double s) {
  return {0.3 * s, std::cos(s), std::sin(s)};
}
inline constexpr double two_turns = 4 * std::numbers::pi;

/// Smoothly graded nodes on it, the last link e^2 times as long as the first one.
inline double graded(double u) {
  return two_turns * (std::exp(2 * u) - 1) / (std::exp(2.0) - 1);
}
inline JetState graded_helix(std::size_t links) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i <= links; ++i)
    places.push_back(on_helix(graded(real(i) / real(links))));
  return jet_through(places);
}

/// What the links of a jet hold together, and the beads that belong to them.
struct Sums {
  double volume = 0, mass = 0, charge = 0;
  Vec3 momentum = Vec3::Zero();
  double kinetic = 0;        ///< sum m v^2
  double stress = 0;         ///< sum V sigma
  double elastic = 0;        ///< sum V sigma^2
  double momentum_scale = 0; ///< sum m |v|, what round-off of the momentum is measured by

  explicit Sums(const JetState& jet) {
    const auto c = jet.columns();
    CompensatedSum v, m, q, px, py, pz, k, s, e, scale;
    for (std::size_t i = 1; i < jet.beads(); ++i) {
      const Vec3 u = c.velocity()[i];
      const double sigma = has_stress(c) ? stress_of(c)[i] : 0;
      v += jet.volume[i], m += jet.mass[i], q += jet.charge[i];
      px += jet.mass[i] * u.x(), py += jet.mass[i] * u.y(), pz += jet.mass[i] * u.z();
      k += jet.mass[i] * u.squaredNorm(), scale += jet.mass[i] * u.norm();
      s += jet.volume[i] * sigma, e += jet.volume[i] * sigma * sigma;
    }
    volume = v, mass = m, charge = q, momentum = {px, py, pz}, kinetic = k;
    stress = s, elastic = e, momentum_scale = scale;
  }
};

inline void expect_same_bead(const JetState& jet, std::size_t bead, const JetState& other,
                             std::size_t other_bead) {
  const Bead a = bead_at(jet, bead), b = bead_at(other, other_bead);
  EXPECT_EQ(a.position, b.position) << bead;
  EXPECT_EQ(a.velocity, b.velocity) << bead;
  EXPECT_EQ(a.declared, b.declared) << bead;
  EXPECT_EQ(a.volume, b.volume) << bead;
  EXPECT_EQ(a.mass, b.mass) << bead;
  EXPECT_EQ(a.charge, b.charge) << bead;
}

/// Bit for bit.
inline void expect_same_jet(const JetState& a, const JetState& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.charge, b.charge);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.has_embryo, b.has_embryo);
  EXPECT_EQ(a.absorbing_plane, b.absorbing_plane);
  ASSERT_EQ(a.landed.size(), b.landed.size());
  for (std::size_t i = 0; i < a.landed.size(); ++i) {
    EXPECT_EQ(a.landed[i].bead, b.landed[i].bead);
    EXPECT_EQ(a.landed[i].time, b.landed[i].time);
    EXPECT_EQ(a.landed[i].radius, b.landed[i].radius);
  }
}

inline double distance(const JetState& jet, std::size_t i, std::size_t j) {
  const auto r = jet.columns().position();
  return (r[i] - r[j]).norm();
}

} // namespace ehdjet::test
