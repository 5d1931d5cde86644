#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <vector>

#include "support/stress.hpp"

namespace ehdjet::test {

/// A chain whose beads are moved by hand, and the stage that force terms look at.
struct Chain {
  explicit Chain(std::size_t n)
      : beads(n)
      , mass(n, 1.0)
      , charge(n, 1.0)
      , volume(n, 1.0)
      , flat(7 * n, 0.0) {}

  [[nodiscard]] JetColumns<double> columns() { return {flat, beads}; }
  void place(std::size_t k, const Vec3& r, const Vec3& v = Vec3::Zero()) {
    columns().position().set(k, r);
    columns().velocity().set(k, v);
  }
  /// Valid until the chain is moved or goes out of scope.
  Stage& stage() {
    stage_.columns = columns();
    stage_.mass = mass, stage_.charge = charge, stage_.volume = volume;
    stage_.link_charge = charge;
    stage_.first = first, stage_.landed = landed;
    stage_.invalidate();
    return stage_;
  }
  /// The force of one term on every bead.
  std::vector<Vec3> force(ForceTerm& term) {
    std::vector<double> x(beads, 0.0), y(beads, 0.0), z(beads, 0.0);
    const Vec3View view{x, y, z};
    term.bind(*table_with_stress());
    term.add_force(stage(), view);
    std::vector<Vec3> f;
    for (std::size_t k = 0; k < beads; ++k) f.push_back(view[k]);
    return f;
  }
  /// d(stress)/dt of every link.
  std::vector<double> stress_rates(ForceTerm& term) {
    std::vector<double> rates(flat.size());
    term.bind(*table_with_stress());
    term.set_column_rates(stage(), {rates, beads});
    const auto column = stress_of(JetColumns<double>{rates, beads});
    return {column.begin(), column.end()};
  }

  std::size_t beads, first = 1;
  std::vector<double> mass, charge, volume, flat;
  std::vector<LandedBead> landed;

private:
  Stage stage_;
};

inline Vec3 sum(const std::vector<Vec3>& vectors) {
  Vec3 total = Vec3::Zero();
  for (const Vec3& v : vectors) total += v;
  return total;
}
inline double sum_of_norms(const std::vector<Vec3>& vectors) {
  double total = 0;
  for (const Vec3& v : vectors) total += v.norm();
  return total;
}

} // namespace ehdjet::test
