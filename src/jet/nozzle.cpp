#include "ehdjet/jet/nozzle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ehdjet {

Vec3 Nozzle::position(double t) const {
  const double angle = angular_frequency * t + phase;
  return {0, amplitude * std::cos(angle), amplitude * std::sin(angle)};
}

Vec3 Nozzle::velocity(double t) const {
  const double angle = angular_frequency * t + phase, speed = amplitude * angular_frequency;
  return {fluid_velocity, -speed * std::sin(angle), speed * std::cos(angle)};
}

Vec3 Nozzle::acceleration(double t) const {
  return -angular_frequency * angular_frequency * position(t);
}

Vec3 Embryo::position(const Vec3& nozzle, const Vec3& bead) const {
  const Vec3 segment = bead - nozzle;
  return nozzle + link_length / segment.norm() * segment;
}

double Embryo::charge_fraction(double d) const {
  const double ramp =
      (d - creation_distance()) / (release_distance() - creation_distance());
  return (1 - std::cos(std::numbers::pi * std::clamp(ramp, 0.0, 1.0))) / 2;
}

double Embryo::charge_fraction_slope(double d) const {
  const double width = release_distance() - creation_distance();
  const double ramp = (d - creation_distance()) / width;
  return std::numbers::pi / (2 * width)
         * std::sin(std::numbers::pi * std::clamp(ramp, 0.0, 1.0));
}

} // namespace ehdjet
