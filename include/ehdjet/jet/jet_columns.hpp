#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>

namespace ehdjet {

/// Names for the columns of one flat ODE vector:  [x | y | z | vx | vy | vz | declared ones].
///
/// shapes : flat is (columns * beads); every column is (beads), index 0 = bead 0, the nozzle
/// units  : [m], [m/s], those of BeadTable; over a rate, per second
/// The same view works over a state, a Runge-Kutta stage and a rate. Which columns there are
/// behind the velocities BeadTable::integrated says.
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
  operator JetColumns<const T>() const { return {flat, beads}; }

  static constexpr std::size_t kinematic_columns = 6;
};

} // namespace ehdjet
