#include "ehdjet/jet/inflow.hpp"

#include <numbers>

namespace ehdjet {

LinkContent LinkContent::of_cylinder(double radius, double length, double density,
                                     double charge_density) {
  const double volume = std::numbers::pi * radius * radius * length;
  return {.volume = volume, .mass = density * volume, .charge = charge_density * volume};
}

} // namespace ehdjet
