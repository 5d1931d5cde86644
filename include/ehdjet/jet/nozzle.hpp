#pragma once

#include "ehdjet/core/columns.hpp"

namespace ehdjet {

/// The nozzle moves on a circle in the plane x = 0 (model 2):
///
///     y = A cos(omega t + phase),   z = A sin(omega t + phase)
///
/// in closed form at every stage time: integrated, the circle would drift. As the end of a link
/// its velocity is (v_s, dy/dt, dz/dt), although x stays 0.
struct Nozzle {
  double fluid_velocity = 0;    ///< v_s [m/s]
  double amplitude = 0;         ///< A [m]
  double angular_frequency = 0; ///< omega [rad/s]
  double phase = 0;             ///< [rad]

  [[nodiscard]] Vec3 position(double t) const;
  [[nodiscard]] Vec3 velocity(double t) const;
  /// Of the circle: what the velocity as the end of a link changes by [m/s^2].
  [[nodiscard]] Vec3 acceleration(double t) const;
};

/// The bead that forms between the nozzle and the first bead (model 4.1).
struct Embryo {
  double link_length = 0; ///< l_step [m]

  /// Distances |r_2 - r_0| at which an embryo is created and released [m].
  [[nodiscard]] double creation_distance() const { return 1.5 * link_length; }
  [[nodiscard]] double release_distance() const { return 2.0 * link_length; }

  /// On the segment from bead 0 to bead 2, l_step away from bead 0.
  [[nodiscard]] Vec3 position(const Vec3& nozzle, const Vec3& bead) const;

  /// Share of its charge that acts when bead 2 is at distance d from the nozzle:
  ///
  ///     f(d) = (1 - cos(pi (d - 1.5 l)/(0.5 l)))/2,   1.5 l <= d <= 2 l;   0 below, 1 above
  [[nodiscard]] double charge_fraction(double d) const;
  /// df/dd [1/m]
  [[nodiscard]] double charge_fraction_slope(double d) const;
};

} // namespace ehdjet
