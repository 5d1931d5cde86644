#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "cross_check_parts.hpp"
#include "key_description.hpp"

namespace ehdjet {
namespace {

/// The law of the stress and its keys.
class RheologyCheck {
public:
  RheologyCheck(const SceneConfig& config, const SceneText& text)
      : fluid_(*config.viscoelasticity)
      , text_(text)
      , model_(fmt::format("viscoelasticity.model = \"{}\"",
                           name_of(fluid_.model, rheologies))) {}

  void run() const {
    if (fluid_.modes)
      check_modes();
    else
      check_moduli();
    const bool giesekus = fluid_.model == Rheology::giesekus,
               oldroyd = fluid_.model == Rheology::oldroyd_b,
               fene = fluid_.model == Rheology::fene_p,
               curve = fluid_.model == Rheology::herschel_bulkley;
    check("mobility", "", fluid_.mobility, giesekus, giesekus);
    check("solvent_viscosity", " Pa s", fluid_.solvent_viscosity,
          oldroyd || giesekus || fene, oldroyd);
    check("extensibility", "", fluid_.extensibility, fene, fene);
    check("consistency", " Pa s^n", fluid_.consistency, curve, curve);
    check("flow_index", "", fluid_.flow_index, curve, curve);
    check("yield_stress", " Pa", fluid_.yield_stress, curve, false);
    check("regularization", " s", fluid_.regularization, curve, false);
    const bool yields = fluid_.yield_stress.value_or(0) > 0;
    if (yields && !fluid_.regularization)
      refuse("yield_stress",
             fmt::format("viscoelasticity.yield_stress = {} Pa needs "
                         "viscoelasticity.regularization, a time in s: the fluid creeps "
                         "at strain rates below its inverse",
                         *fluid_.yield_stress));
    if (fluid_.regularization && !yields)
      refuse("regularization",
             fmt::format("viscoelasticity.regularization = {} s has no meaning without "
                         "viscoelasticity.yield_stress. Remove it",
                         *fluid_.regularization));
  }

private:
  /// elastic_modulus and viscosity.
  struct Modulus {
    const char *key, *meaning;
    const Range& range;
    const std::optional<double>& value;
  };
  [[nodiscard]] std::array<Modulus, 2> moduli() const {
    return {
        {{"elastic_modulus", "elastic modulus, G", elastic_moduli, fluid_.elastic_modulus},
         {"viscosity", "viscosity, mu", viscosities, fluid_.viscosity}}};
  }

  void check_modes() const {
    const std::string modes = "viscoelasticity.modes = " + toml_text(*fluid_.modes);
    if (!fluid_.is_tensorial())
      refuse("modes",
             fmt::format("{} has no meaning with {}: only the stress tensors of "
                         "\"upper-convected-maxwell\", \"oldroyd-b\", \"giesekus\" and "
                         "\"fene-p\" have modes. Remove it",
                         modes, model_));
    for (const Modulus& m : moduli())
      if (m.value)
        refuse(m.key,
               fmt::format("viscoelasticity.{} = {} {} and {}: moduli and relaxation "
                           "times are given twice. Remove one",
                           m.key, *m.value, m.range.unit, modes));
  }
  void check_moduli() const {
    for (const Modulus& m : moduli()) {
      if (!m.value)
        refuse(m.key, fmt::format("viscoelasticity.{} is missing: must be {} ({})", m.key,
                                  m.range.text(), m.meaning));
      if (fluid_.model == Rheology::herschel_bulkley && !(*m.value > 0))
        refuse(m.key,
               fmt::format("viscoelasticity.{} = {} {}: must be greater than 0 {} with {}, "
                           "viscosity/elastic_modulus is the time that the stress takes to "
                           "follow the flow curve",
                           m.key, *m.value, m.range.unit, m.range.unit, model_));
    }
  }
  void check(const char* key, const char* unit, std::optional<double> value, bool allowed,
             bool needed) const {
    if (value && !allowed)
      refuse(key, fmt::format("viscoelasticity.{} = {}{} has no meaning with {}. Remove it",
                              key, *value, unit, model_));
    if (!value && needed)
      refuse(key,
             fmt::format("viscoelasticity.{} is missing: it is needed with {}; {}", key,
                         model_, key_description(fmt::format("viscoelasticity.{}", key))));
  }
  [[noreturn]] void refuse(const char* key, const std::string& why) const {
    text_.fail(fmt::format("viscoelasticity.{}", key), why);
    throw; // `fail` does not return
  }

  const ViscoelasticityConfig& fluid_;
  const SceneText& text_;
  std::string model_;
};

/// Keys of other tables that are about a stress which is integrated.
void check_stress_keys(const SceneConfig& c, const SceneText& text) {
  if (!c.viscoelasticity || c.viscoelasticity->model != Rheology::kelvin_voigt) return;
  const char* with = "viscoelasticity.model = \"kelvin-voigt\": its stress follows from "
                     "lengths and velocities and is not integrated. Remove it";
  if (c.integrator.stress_scale)
    text.fail("integrator.stress_scale",
              fmt::format("integrator.stress_scale = {} Pa has no meaning with {}",
                          *c.integrator.stress_scale, with));
  if (c.refinement && c.refinement->stress)
    text.fail("refinement.stress",
              fmt::format("refinement.stress = \"{}\" has no meaning with {}",
                          name_of(*c.refinement->stress, column_remaps), with));
  if (c.nozzle && c.nozzle->nozzle_stress && !(*c.viscoelasticity->elastic_modulus > 0))
    text.fail("nozzle.nozzle_stress",
              fmt::format("nozzle.nozzle_stress = {} Pa and "
                          "viscoelasticity.elastic_modulus = 0 Pa: nothing holds it. "
                          "Remove it",
                          *c.nozzle->nozzle_stress));
}

} // namespace

void check_rheology(const SceneConfig& c, const SceneText& text) {
  if (c.viscoelasticity) RheologyCheck(c, text).run();
  check_stress_keys(c, text);
}

void check_air(const SceneConfig& c, const SceneText& text) {
  if (!c.air) return;
  if (c.air->velocity && c.air->profile)
    text.fail(
        "air.profile",
        fmt::format("air.velocity and air.profile = \"{}\": the air has one velocity, or "
                    "one over x. Remove one",
                    *c.air->profile));
}

void check_evaporation(const SceneConfig& c, const SceneText& text) {
  if (!c.evaporation) return;
  const EvaporationConfig& e = *c.evaporation;
  if (!c.air)
    text.fail("evaporation",
              "[evaporation] needs [air], into which the solvent evaporates");
  if (!(e.solid_fraction > e.polymer_fraction))
    text.fail(
        "evaporation.solid_fraction",
        fmt::format("evaporation.solid_fraction = {} and evaporation.polymer_fraction = "
                    "{}: must be more than that, or nothing could evaporate",
                    e.solid_fraction, e.polymer_fraction));
  if (c.viscoelasticity
      && (c.viscoelasticity->model == Rheology::kelvin_voigt
          || c.viscoelasticity->model == Rheology::herschel_bulkley))
    text.fail(
        "viscoelasticity.model",
        fmt::format(
            "viscoelasticity.model = \"{}\" and [evaporation]: only the modulus and the "
            "relaxation time of a Maxwell fluid and of the stress tensors follow the "
            "polymer fraction. Take another model",
            name_of(c.viscoelasticity->model, rheologies)));
  for (const auto& [key, value] : {std::pair{"viscosity_exponent", e.viscosity_exponent},
                                   {"viscosity_power", e.viscosity_power}})
    if (value && !carries_stress(c))
      text.fail(
          fmt::format("evaporation.{}", key),
          fmt::format(
              "evaporation.{} = {} has no meaning without [viscoelasticity], or with one "
              "without modulus or viscosity: nothing thickens. Remove it",
              key, *value));
  // Volumes of real solutions do not add up exactly.
  constexpr double tolerated = 0.1;
  const double density = e.solution().density();
  if (c.nozzle && std::abs(c.nozzle->density / density - 1) > tolerated)
    text.fail("nozzle.density",
              fmt::format(
                  "nozzle.density = {} kg/m^3, and a solution of [evaporation] has {:.4g} "
                  "kg/m^3: must agree within {:.0f} %",
                  c.nozzle->density, density, 100 * tolerated));
}

} // namespace ehdjet
