#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/core/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

/// Sets of charges that solvers are timed on.
namespace ehdjet::bench {

struct Charges {
  std::vector<double> x, y, z, q;

  void add(const Vec3& r, double charge) {
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
    c.add(point((static_cast<double>(k - 1) + part) / fine),
          1e-10 * (1 + 0.1 * std::sin(14 * std::numbers::pi * s / arc[fine])));
  }
  return c;
}

/// 16 cm, evenly spaced.
inline Charges line(std::size_t n) {
  Charges c;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n - 1);
    c.add({0.16 * t, 0, 0}, 1e-10 * (1 + 0.1 * std::sin(14 * std::numbers::pi * t)));
  }
  return c;
}

/// A circle of 4 cm radius: errors of all clusters add up with one sign.
inline Charges ring(std::size_t n) {
  Charges c;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle =
        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    c.add({0.04 * std::cos(angle), 0.04 * std::sin(angle), 0}, 1e-10);
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
    c.add({x, y, z}, 1e-10);
  }
  return c;
}

/// The beads of a frame of a run (`ehdjet export --beads`), each link cut into equal pieces until
/// there are
/// about n: a real jet at any resolution. Charges go with the length of the pieces.
inline Charges real_jet(const std::filesystem::path& beads, std::size_t n) {
  CsvTable table(beads, {"x_m", "y_m", "z_m", "charge_c", "embryo"}, {});
  Charges knots;
  while (table.next_row())
    if (table.value(4) == 0)
      knots.add({table.value(0), table.value(1), table.value(2)}, table.value(3));
  const std::size_t pieces = std::max<std::size_t>(1, n / (knots.size() - 1));
  Charges c;
  for (std::size_t k = 1; k < knots.size(); ++k)
    for (std::size_t j = 1; j <= pieces; ++j) {
      const double t = static_cast<double>(j) / static_cast<double>(pieces);
      c.add(knots.r()[k - 1] + t * (knots.r()[k] - knots.r()[k - 1]),
            knots.q[k] / static_cast<double>(pieces));
    }
  return c;
}

} // namespace ehdjet::bench
