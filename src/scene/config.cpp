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

JetAxis ArrayConfig::axis(std::size_t j) const {
  const auto from_middle = [this](std::size_t place, std::size_t places) {
    return (static_cast<double>(place) - static_cast<double>(places - 1) / 2) * spacing;
  };
  return {.y = from_middle(j % columns, columns), .z = from_middle(j / columns, rows)};
}

double ArrayConfig::phase(std::size_t j) const {
  if (phases == ArrayPhases::equal) return 0;
  return 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(jets());
}

bool can_have_two_rates(const SceneConfig& c) {
  const IntegratorConfig& i = c.integrator;
  // Links that are cut at the end of the step in which they become too long need short steps.
  const bool cuts_at_step_ends =
      c.refinement && c.refinement->mesh == RefinedMesh::cut && !c.refinement->interval;
  return (i.method == "auto" || i.method == "two-rate") && c.nozzle && c.coulomb && !c.array
         && !has_images(c) && i.rtol && i.events == EventPlacement::located
         && i.landings == LandingSteps::automatic && !cuts_at_step_ends;
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
