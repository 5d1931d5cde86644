#pragma once

#include "ehdjet/core/columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

/// Sets of charges for the Coulomb solvers: places, and what the charges are.
namespace ehdjet::validation {

struct Charges {
  std::vector<double> x, y, z, q;

  void add(const Vec3& r, double charge = 1e-10) {
    x.push_back(r.x()), y.push_back(r.y()), z.push_back(r.z()), q.push_back(charge);
  }
  [[nodiscard]] std::size_t size() const { return q.size(); }
  [[nodiscard]] ConstVec3View r() const { return {x, y, z}; }
};

/// Straight for 1.6 cm, then a helix whose radius grows to 4 cm in 20 turns, 16 cm downstream:
/// 254 cm of jet with evenly spaced beads.
inline Charges jet(std::size_t n) {
  constexpr int fine = 200000;              // points of the arc length table
  const auto point = [](double t) -> Vec3 { // [m]
    const double wide = std::max(0.0, (t - 0.1) / 0.9),
                 angle = 40 * std::numbers::pi * wide;
    return {0.16 * t, 0.04 * wide * std::cos(angle), 0.04 * wide * std::sin(angle)};
  };
  std::vector<double> arc(fine + 1);
  for (int k = 1; k <= fine; ++k)
    arc[static_cast<std::size_t>(k)] =
        arc[static_cast<std::size_t>(k - 1)]
        + (point(double(k) / fine) - point(double(k - 1) / fine)).norm();
  Charges c;
  std::size_t k = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = arc[fine] * static_cast<double>(i) / static_cast<double>(n - 1);
    while (k < fine && arc[k] < s) ++k;
    const double part = (s - arc[k - 1]) / (arc[k] - arc[k - 1]);
    c.add(point((static_cast<double>(k - 1) + part) / fine));
  }
  return c;
}

/// 16 cm, evenly spaced.
inline Charges line(std::size_t n) {
  Charges c;
  for (std::size_t i = 0; i < n; ++i)
    c.add({0.16 * static_cast<double>(i) / static_cast<double>(n - 1), 0, 0});
  return c;
}

/// A circle of 4 cm radius: errors of all clusters add up with one sign.
inline constexpr double ring_radius = 0.04; // [m]
inline Charges ring(std::size_t n) {
  Charges c;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    c.add({ring_radius * std::cos(angle), ring_radius * std::sin(angle), 0});
  }
  return c;
}

/// Ten turns of 1 cm radius, 16 cm long.
struct Helix {
  std::size_t n;
  static constexpr double radius = 0.01, length = 0.16, turns = 10; // [m], [m], [-]
  /// From one charge to the next.
  [[nodiscard]] double turn() const {
    return 2 * std::numbers::pi * turns / static_cast<double>(n - 1);
  }
  [[nodiscard]] double rise() const { return length / static_cast<double>(n - 1); }
};
inline Charges helix(std::size_t n) {
  Charges c;
  const Helix h{n};
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<double>(i);
    c.add({h.rise() * k, h.radius * std::cos(h.turn() * k),
           h.radius * std::sin(h.turn() * k)});
  }
  return c;
}

/// At random in a cube of 16 cm, in no order.
inline Charges cube(std::size_t n) {
  std::mt19937_64 bits(1);
  std::uniform_real_distribution<double> place(0, 0.16);
  Charges c;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = place(bits), y = place(bits), z = place(bits);
    c.add({x, y, z});
  }
  return c;
}

/// Multiplies the charges: "uniform" by one, "modulated" by 1 + 0.1 sin along the chain,
/// "alternating" by 1 and -1, "decades" by anything between 1e-10 and 1, at random.
inline void distribute(Charges& c, std::string_view distribution) {
  std::mt19937_64 bits(2);
  std::uniform_real_distribution<double> exponent(-10, 0);
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(c.size() - 1);
    if (distribution == "modulated")
      c.q[i] *= 1 + 0.1 * std::sin(14 * std::numbers::pi * t);
    if (distribution == "alternating" && i % 2 == 1) c.q[i] = -c.q[i];
    if (distribution == "decades") c.q[i] *= std::pow(10, exponent(bits));
  }
}

} // namespace ehdjet::validation
