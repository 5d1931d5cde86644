#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Velocity of the air at places along the axis; between them it is interpolated linearly, beyond them it
/// stays as at the ends.
///
/// shapes : all of the same length, x ascending
/// units  : [m], [m/s]
struct AirProfile {
  std::vector<double> x, ux, uy, uz;
  bool operator==(const AirProfile&) const = default;
};

/// The air that a jet moves through (model 2.1). It is not changed by the jet.
class AirFlow {
public:
  /// density [kg/m^3], kinematic viscosity [m^2/s], both > 0; velocity u [m/s]
  AirFlow(double density, double kinematic_viscosity, const Vec3& velocity);
  AirFlow(double density, double kinematic_viscosity, AirProfile velocity);

  [[nodiscard]] double density() const { return density_; }
  [[nodiscard]] double kinematic_viscosity() const { return kinematic_viscosity_; }
  /// u at the place x on the axis [m/s].
  [[nodiscard]] Vec3 velocity(double x) const;
  /// Of the beads from `begin` on, as many as w has: v - u(x) [m/s].
  void relative_velocity(ConstVec3View r, ConstVec3View v, std::size_t begin,
                         Vec3View w) const;

private:
  double density_, kinematic_viscosity_;
  Vec3 velocity_ = Vec3::Zero();
  AirProfile profile_; // empty: the velocity is uniform
};

} // namespace ehdjet
