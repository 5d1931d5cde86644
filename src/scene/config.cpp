#include "ehdjet/scene/config.hpp"

#include <numbers>

namespace ehdjet {

double NozzleConfig::section() const {
  return std::numbers::pi * radius * radius;
}

double NozzleConfig::fluid_velocity() const {
  return flow_rate ? *flow_rate / section() : velocity.value_or(0);
}

double NozzleConfig::fluid_charge_density() const {
  return current && flow_rate ? *current / *flow_rate : charge_density.value_or(0);
}

bool has_near_field(const SceneConfig& c) {
  return c.coulomb && c.coulomb->near_field != NearFieldForm::point;
}

// A link of less than four radii pushes its ends together instead of apart. The first link of a pump is
// half as long after a cut.
bool softens_pairs(const SceneConfig& c) {
  if (!has_near_field(c)) return false;
  constexpr double long_enough = 4; // radii
  if (!c.nozzle) return c.coulomb->softened_pairs.value_or(false);
  const double shortest = c.nozzle->inflow == InflowKind::pump ? c.nozzle->link_length / 2
                                                               : c.nozzle->link_length;
  return c.coulomb->softened_pairs.value_or(shortest < long_enough * c.nozzle->radius);
}

} // namespace ehdjet
