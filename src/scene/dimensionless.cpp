#include "ehdjet/scene/dimensionless.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"

#include <cmath>
#include <numbers>

namespace ehdjet {

double field_strength(const SceneConfig& config) {
  if (!config.field) return 0;
  if (config.field->strength) return *config.field->strength;
  EHDJET_EXPECTS(config.field->potential && config.collector);
  return *config.field->potential / config.collector->distance;
}

bool carries_stress(const SceneConfig& c) {
  if (!c.viscoelasticity) return false;
  const ViscoelasticityConfig& fluid = *c.viscoelasticity;
  return !fluid.relaxation_modes().empty() || fluid.instant_viscosity() > 0
         || (fluid.model == Rheology::kelvin_voigt && fluid.elastic_modulus > 0.0);
}

std::optional<DimensionlessGroups> dimensionless_groups(const SceneConfig& config) {
  if (!config.nozzle || !config.viscoelasticity) return std::nullopt;
  const NozzleConfig& n = *config.nozzle;
  const ViscoelasticityConfig& fluid = *config.viscoelasticity;
  double G = fluid.elastic_modulus.value_or(0), mu = fluid.viscosity.value_or(0);
  if (fluid.modes)
    for (const RelaxationMode& m : *fluid.modes)
      G += m.modulus, mu += m.modulus * m.relaxation_time;
  if (G == 0 || mu == 0 || n.fluid_charge_density() == 0) return std::nullopt;

  const double section = std::numbers::pi * n.radius * n.radius;
  const double m = n.density * section * n.link_length;
  const double q = n.fluid_charge_density() * section * n.link_length;
  const double tau = mu / G;
  const double L0 = std::sqrt(constants::coulomb * q * q / (section * G));

  DimensionlessGroups groups;
  groups.length = L0;
  groups.time = tau;
  groups.coulomb = constants::coulomb * q * q * tau * tau / (L0 * L0 * L0 * m);
  groups.viscoelastic = section * mu * tau / (m * L0);
  groups.viscoelastic_jetspin = L0 * mu * tau / m;
  groups.nozzle_motion = n.angular_frequency * tau;
  if (config.field) groups.field = q * field_strength(config) * tau * tau / (m * L0);
  if (config.surface_tension)
    groups.surface_tension =
        config.surface_tension->coefficient * section * tau * tau / (m * L0 * L0);
  if (config.collector) groups.collector = config.collector->distance / L0;
  if (config.gravity) groups.gravity = config.gravity->acceleration * tau * tau / L0;
  return groups;
}

} // namespace ehdjet
