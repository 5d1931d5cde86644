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

bool ViscoelasticityConfig::is_tensorial() const {
  return model == Rheology::upper_convected_maxwell || model == Rheology::oldroyd_b
         || model == Rheology::giesekus || model == Rheology::fene_p;
}

std::vector<RelaxationMode> ViscoelasticityConfig::relaxation_modes() const {
  if (modes) return *modes;
  if (model == Rheology::kelvin_voigt || !(elastic_modulus > 0.0 && viscosity > 0.0))
    return {};
  return {{.modulus = *elastic_modulus, .relaxation_time = *viscosity / *elastic_modulus}};
}

double ViscoelasticityConfig::instant_viscosity() const {
  if (model == Rheology::kelvin_voigt) return viscosity.value_or(0);
  return 3 * solvent_viscosity.value_or(0); // Trouton's ratio
}

bool has_images(const SceneConfig& c) {
  return c.collector && c.collector->images != CollectorImages::none;
}

bool has_nozzle_charge(const SceneConfig& c) {
  return c.coulomb && c.nozzle && c.nozzle->inflow == InflowKind::pump
         && !(c.collector && c.collector->images == CollectorImages::plates);
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
