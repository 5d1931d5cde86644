#pragma once

#include "support/scenes.hpp"

/// Jets that a pump feeds.
namespace ehdjet::test {

inline constexpr double mL_h = 1e-6 / 3600; ///< [m^3/s]

/// The PVP fluid, fed straight down, without mutual Coulomb forces and without a collector.
inline Scene straight_pumped(double flow_rate, double viscosity, double link_length,
                             double rtol = 1e-6) {
  Scene s;
  s.config.nozzle = NozzleConfig{.radius = pvp::radius,
                                 .link_length = link_length,
                                 .density = pvp::density,
                                 .charge_density = pvp::charge_density,
                                 .inflow = InflowKind::pump,
                                 .flow_rate = flow_rate};
  s.config.field = FieldConfig{.potential = {}, .strength = pvp::potential / pvp::distance};
  s.config.gravity = GravityConfig{pvp::gravity};
  s.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, viscosity};
  s.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension,
                                                  .form = SurfaceTensionForm::line};
  integrate(s, "dormand-prince", rtol);
  return s;
}

/// A whipping jet whose observables converge in every parameter of the mesh.
inline Scene jet_k(double link_length, double refinement_length, double rtol = 1e-5) {
  Scene s = straight_pumped(65 * mL_h, 50 * poise, link_length, rtol);
  NozzleConfig& n = *s.config.nozzle;
  n.charge_density = 31000 * statC / cm3;
  n.amplitude = 1e-3 * cm, n.angular_frequency = 1e4;
  s.config.collector = CollectorConfig{.distance = pvp::distance};
  s.config.field = FieldConfig{.potential = 38 * statV, .strength = {}};
  s.config.viscoelasticity->elastic_modulus = 6e4 * dyn_cm2;
  s.config.coulomb =
      CoulombConfig{.near_field = NearFieldForm::fixed, .softened_pairs = true};
  s.config.refinement = RefinementConfig{.length = refinement_length, .interval = 1e-3};
  return s;
}

} // namespace ehdjet::test
