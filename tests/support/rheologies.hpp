#pragma once

#include "ehdjet/scene/config.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"

/// The PVP fluid with every law of the stress.
namespace ehdjet::test {

struct NamedRheology {
  std::string name;
  ViscoelasticityConfig fluid;
};
inline std::ostream& operator<<(std::ostream& os, const NamedRheology& r) {
  return os << r.name;
}

inline std::vector<NamedRheology> rheologies_of_pvp() {
  const double g = pvp::modulus, mu = pvp::viscosity, tau = pvp::relaxation_time;
  std::vector<NamedRheology> all;
  const auto add = [&](const char* name, Rheology model) -> ViscoelasticityConfig& {
    all.push_back({name, {.elastic_modulus = g, .viscosity = mu, .model = model}});
    return all.back().fluid;
  };
  add("maxwell", Rheology::maxwell);
  add("upper_convected_maxwell", Rheology::upper_convected_maxwell);
  add("oldroyd_b", Rheology::oldroyd_b).solvent_viscosity = 0.05;
  add("giesekus", Rheology::giesekus).mobility = 0.1;
  {
    ViscoelasticityConfig& fene = add("fene_p_modes", Rheology::fene_p);
    fene.elastic_modulus.reset(), fene.viscosity.reset();
    fene.modes = std::vector<RelaxationMode>{{0.8 * g, tau}, {0.2 * g, 4 * tau}};
    fene.extensibility = 400, fene.solvent_viscosity = 0.02;
  }
  add("kelvin_voigt", Rheology::kelvin_voigt).viscosity = 0.2;
  {
    ViscoelasticityConfig& curve = add("herschel_bulkley", Rheology::herschel_bulkley);
    curve.consistency = 10, curve.flow_index = 0.8;
    curve.yield_stress = 50, curve.regularization = 0.01;
  }
  return all;
}

} // namespace ehdjet::test
