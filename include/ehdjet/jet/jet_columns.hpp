#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>

namespace ehdjet {

/// Names for the columns of one flat ODE vector:  [x | y | z | vx | vy | vz | stress].
///
/// shapes : flat is (columns * beads); every column is (beads), index 0 = bead 0, the nozzle
/// units  : [m], [m/s], [Pa]; over a rate, per second
/// The same view works over a state, a Runge-Kutta stage and a rate. A scene without
/// viscoelasticity has no stress column: `stress()` is empty and nothing is stored for it.
template <class T>
struct JetColumns {
  std::span<T> flat;
  std::size_t beads = 0;

  [[nodiscard]] std::size_t count() const { return flat.size() / beads; }
  [[nodiscard]] std::span<T> column(std::size_t c) const {
    return flat.subspan(c * beads, beads);
  }
  [[nodiscard]] Vec3Columns<T> position() const {
    return {column(0), column(1), column(2)};
  }
  [[nodiscard]] Vec3Columns<T> velocity() const {
    return {column(3), column(4), column(5)};
  }
  [[nodiscard]] bool has_stress() const { return flat.size() > kinematic_columns * beads; }
  [[nodiscard]] std::span<T> stress() const {
    return has_stress() ? column(6) : std::span<T>{};
  }
  operator JetColumns<const T>() const { return {flat, beads}; }

  static constexpr std::size_t kinematic_columns = 6;
};

} // namespace ehdjet
