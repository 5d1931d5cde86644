#include "cross_checks.hpp"

#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/schema.hpp"
#include "ehdjet/scene/stability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace ehdjet {
namespace {

constexpr double default_rtol = 1e-6;
/// More rows than this are a mistyped interval: 1e8 rows of observables are 10 GB.
constexpr double most_rows = 1e8;
/// So many steps would take weeks with 100 beads.
constexpr double too_many_steps = 1e8;
/// Fewer steps are refused, too, if stability needs steps that are so much shorter than accuracy's.
constexpr double many_steps = 1e6, far_below = 1e-3;

/// A key that the scene must give, or must not give.
template <class Refuse, class T>
void need(const Refuse& refuse, const char* key, const std::optional<T>& value,
          const char* with) {
  if (!value)
    refuse("", fmt::format("nozzle.{} is missing: it is needed with {}", key, with));
}
template <class Refuse, class T>
void exclude(const Refuse& refuse, const char* key, const std::optional<T>& value,
             const char* with) {
  if (value)
    refuse(key, fmt::format("nozzle.{} = {} has no meaning with {}. Remove it", key, *value,
                            with));
}

void check_inflow(const SceneConfig& c, const SceneText& text) {
  const NozzleConfig& n = *c.nozzle;
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(*key == 0 ? "nozzle" : fmt::format("nozzle.{}", key), why);
  };
  if (n.inflow == InflowKind::embryo) {
    const char* with = "inflow = \"embryo\" (the default)";
    exclude(refuse, "flow_rate", n.flow_rate, with);
    exclude(refuse, "current", n.current, with);
    exclude(refuse, "nozzle_stress", n.nozzle_stress, with);
    exclude(refuse, "nozzle_charge_length", n.nozzle_charge_length, with);
    exclude(refuse, "conductivity", n.conductivity, with);
    need(refuse, "velocity", n.velocity, with);
    need(refuse, "charge_density", n.charge_density, with);
    return;
  }
  const char* with = "inflow = \"pump\"";
  need(refuse, "flow_rate", n.flow_rate, with);
  exclude(refuse, "velocity", n.velocity,
          "inflow = \"pump\": it follows from nozzle.flow_rate and nozzle.radius");
  if (n.current && n.charge_density)
    refuse("current",
           fmt::format("nozzle.current = {} A and nozzle.charge_density = {} C/m^3: their "
                       "ratio is nozzle.flow_rate. Remove one",
                       *n.current, *n.charge_density));
  if (!n.current && !n.charge_density)
    refuse("", "neither nozzle.current nor nozzle.charge_density is given: exactly one of "
               "them is needed with inflow = \"pump\"");
  if (!c.coulomb)
    exclude(refuse, "nozzle_charge_length", n.nozzle_charge_length,
            "no [coulomb]: charges do not act on each other");
  if (!carries_stress(c))
    exclude(
        refuse, "nozzle_stress", n.nozzle_stress,
        "no [viscoelasticity], or one without modulus or viscosity: there is no stress");
  if (n.insertion_velocity != InsertionVelocity::half)
    refuse("insertion_velocity",
           fmt::format("nozzle.insertion_velocity = \"{}\" has no meaning with {}: no bead "
                       "is released. Remove it",
                       name_of(n.insertion_velocity, insertion_velocities), with));
}

void check_jet(const SceneConfig& c, const SceneText& text) {
  if (c.nozzle && c.chain)
    text.fail("chain",
              "both [nozzle] and [chain] are given: a jet is born at a nozzle or is a "
              "given chain of beads. Remove one");
  if (!c.nozzle && !c.chain)
    text.fail(
        "",
        "neither [nozzle] nor [chain] is given: exactly one of them says what the jet is");
  if (!c.nozzle) return;

  check_inflow(c, text);
  const double a = c.nozzle->radius, l = c.nozzle->link_length;
  const bool has_no_pairs = c.nozzle->inflow == InflowKind::pump && !c.coulomb;
  if (a > l && !softens_pairs(c) && !has_no_pairs)
    text.fail("nozzle.radius",
              fmt::format(
                  "nozzle.radius = {} m and nozzle.link_length = {} m: the radius must be "
                  "at most the link length, beads stand for slender pieces of jet, "
                  "unless pairs are softened. Lengths are in metres",
                  a, l));
  if (c.collector && c.collector->distance <= 2 * l)
    text.fail("collector.distance",
              fmt::format(
                  "collector.distance = {} m and nozzle.link_length = {} m: the collector "
                  "must be more than two link lengths away, that is where a bead leaves "
                  "the nozzle. Lengths are in metres",
                  c.collector->distance, l));
}

void check_field(const SceneConfig& c, const SceneText& text) {
  if (!c.field) return;
  const std::optional<double>&potential = c.field->potential, &strength = c.field->strength;
  if (potential && strength)
    text.fail("field.strength",
              fmt::format(
                  "field.potential = {} V and field.strength = {} V/m: exactly one of them "
                  "is needed. Remove one",
                  *potential, *strength));
  if (!potential && !strength)
    text.fail("field",
              "[field] has neither field.potential nor field.strength: exactly one of "
              "them is needed");
  if (potential && !c.collector)
    text.fail(
        "field.potential",
        fmt::format("field.potential = {} V needs collector.distance, the field is their "
                    "ratio: add [collector] or give field.strength",
                    *potential));
}

void check_waveform(const SceneConfig& c, const SceneText& text) {
  if (!c.field) return;
  const FieldWaveform waveform = c.field->waveform;
  const std::string is =
      fmt::format("field.waveform = \"{}\"", name_of(waveform, field_waveforms));
  const auto check = [&](const char* key, const std::optional<double>& value,
                         const char* unit, FieldWaveform its) {
    if (waveform == its && !value)
      text.fail("field", fmt::format("field.{} is missing: it is needed with {}", key, is));
    if (waveform != its && value)
      text.fail(fmt::format("field.{}", key),
                fmt::format("field.{} = {} {} has no meaning with {}: it needs waveform = "
                            "\"{}\". Remove it",
                            key, *value, unit, is, name_of(its, field_waveforms)));
  };
  check("frequency", c.field->frequency, "1/s", FieldWaveform::square);
  check("time_constant", c.field->time_constant, "s", FieldWaveform::rc);
}

void check_images(const SceneConfig& c, const SceneText& text) {
  if (!has_images(c)) return;
  const auto refuse = [&](const char* why) {
    text.fail("collector.images",
              fmt::format("collector.images = \"{}\" {}",
                          name_of(c.collector->images, collector_images), why));
  };
  if (!c.coulomb)
    refuse("needs [coulomb]: without it charges do not act on each other, nor do their "
           "images");
  if (c.collector->charge != CollectorCharge::grounded)
    refuse(
        "needs collector.charge = \"grounded\" (the default): a charge on a conductor is "
        "cancelled by its image");
  if (c.collector->images == CollectorImages::plates
      && !(c.nozzle && c.nozzle->inflow == InflowKind::pump))
    refuse("needs nozzle.inflow = \"pump\": the nozzle's plate takes away the push of the "
           "nozzle bead that draws beads out of it. Take \"collector\"");
}

void check_collector(const SceneConfig& c, const SceneText& text) {
  if (!c.collector) return;
  const auto& u = c.collector->velocity;
  if (u && (*u)[0] != 0)
    text.fail(
        "collector.velocity",
        fmt::format(
            "collector.velocity = [{}, {}, {}] m/s: the first component must be 0 m/s, "
            "the collector moves in its plane",
            (*u)[0], (*u)[1], (*u)[2]));
  const bool has_mat = c.collector->charge == CollectorCharge::kept_on_mat;
  if (has_mat && !c.coulomb)
    text.fail("collector.charge",
              "collector.charge = \"kept-on-mat\" needs [coulomb]: without it charges do "
              "not act on each other");
  check_images(c, text);
  if (c.collector->decay_time && !has_mat)
    text.fail("collector.decay_time",
              fmt::format("collector.decay_time = {} s needs collector.charge = "
                          "\"kept-on-mat\": only charges that stay can decay. Remove it",
                          *c.collector->decay_time));
}

void settle_step(IntegratorConfig& i, const SceneText& text) {
  const IntegratorDescription& method = integration_method(i.method);
  const bool has_error_estimate = method.estimates_errors;
  const std::string method_is = fmt::format("integrator.method = \"{}\"", i.method);
  if (i.rtol && i.step)
    text.fail(
        "integrator.step",
        fmt::format("integrator.rtol = {} and integrator.step = {} s: the step is adaptive "
                    "or fixed. Remove one",
                    *i.rtol, *i.step));
  if (i.step && method.kind == MethodKind::chooses)
    text.fail("integrator.step",
              fmt::format(
                  "integrator.step = {} s and {}: it chooses the steps and methods that a "
                  "tolerance allows. Name another method, or give integrator.rtol instead",
                  *i.step, method_is));
  if (i.rtol && !has_error_estimate)
    text.fail(
        "integrator.rtol",
        fmt::format("integrator.rtol = {} and {}: this method has no error estimate. Give "
                    "integrator.step, or leave the method to \"auto\"",
                    *i.rtol, method_is));
  if (!i.rtol && !i.step) {
    if (!has_error_estimate)
      text.fail("integrator.method",
                fmt::format(
                    "{} needs integrator.step: this method has no error estimate to choose "
                    "its own steps by",
                    method_is));
    i.rtol = default_rtol;
  }
}

void check_adaptive_keys(const IntegratorConfig& i, const SceneText& text) {
  if (i.step) {
    for (const auto& [name, value] : {std::pair{"initial_step", i.initial_step},
                                      {"max_step", i.max_step},
                                      {"position_scale", i.position_scale},
                                      {"stress_scale", i.stress_scale}})
      if (value)
        text.fail(
            fmt::format("integrator.{}", name),
            fmt::format("integrator.{} = {} and integrator.step = {} s: with a fixed step "
                        "there is no error control. Remove one",
                        name, *value, *i.step));
    return;
  }
  for (const auto& [name, value] :
       {std::pair{"initial_step", i.initial_step}, {"max_step", i.max_step}})
    if (value && *value < i.min_step)
      text.fail(fmt::format("integrator.{}", name),
                fmt::format(
                    "integrator.{} = {} s and integrator.min_step = {} s: must be at least "
                    "the shortest step",
                    name, *value, i.min_step));
}

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
      refuse(key, fmt::format("viscoelasticity.{} is missing: it is needed with {}", key,
                              model_));
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

/// Two rates are for beads that are born at a nozzle and repel each other.
void check_two_rates(const SceneConfig& c, const SceneText& text) {
  const IntegratorConfig& i = c.integrator;
  const bool named = i.method == "two-rate";
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("integrator.{}", key), why);
  };
  const char* missing = !c.nozzle    ? "[nozzle], where the fast beads are"
                        : !c.coulomb ? "[coulomb], whose sums it saves"
                        : has_images(c)
                            ? "collector.images = \"none\": images of near beads are far"
                            : nullptr;
  if (named && missing != nullptr)
    refuse("method",
           fmt::format("integrator.method = \"two-rate\" needs {}. Take \"auto\" (the "
                       "default)",
                       missing));
  if (named && i.events == EventPlacement::step_end)
    refuse("events",
           "integrator.events = \"step-end\" and integrator.method = \"two-rate\": "
           "beads are born within its steps. Take \"located\" (the default)");
  if (named && i.landings == LandingSteps::located)
    refuse("landings",
           "integrator.landings = \"located\" and integrator.method = \"two-rate\": "
           "beads land within its steps. Take \"auto\" (the default)");
  if (named && c.refinement && c.refinement->mesh == RefinedMesh::cut
      && !c.refinement->interval)
    refuse("method", "integrator.method = \"two-rate\" and refinement.mesh = \"cut\" need "
                     "refinement.interval: without it links are cut at the ends of steps, "
                     "and these steps are "
                     "long");
  const bool may = (named || i.method == "auto") && missing == nullptr && !c.array;
  for (const auto& [key, given] : {std::pair{"inner_beads", i.inner_beads.has_value()},
                                   {"downstream_rtol", i.downstream_rtol.has_value()}})
    if (given && !may)
      refuse(
          key,
          fmt::format(
              "integrator.{} is about two rates, which this scene cannot have: they "
              "need [nozzle], [coulomb], no [array] and integrator.method = \"two-rate\" "
              "or \"auto\". Remove it",
              key));
}

template <class Refuse>
void check_near_field(const SceneConfig& c, const Refuse& refuse) {
  const CoulombConfig& s = *c.coulomb;
  const bool is_point = s.near_field == NearFieldForm::point;
  if (is_point && s.softened_pairs.value_or(false))
    refuse(
        "softened_pairs",
        "coulomb.softened_pairs = true and coulomb.near_field = \"point\": only the near "
        "field of a thread knows what softened pairs leave out. Give coulomb.near_field = "
        "\"free-surface\"");
  if (s.softening_range && !softens_pairs(c))
    refuse("softening_range",
           fmt::format("coulomb.softening_range = {}: no pairs are softened. Give "
                       "coulomb.softened_pairs = true with a near field, or remove it",
                       *s.softening_range));
  if (s.near_field == NearFieldForm::fixed && c.output.budget)
    refuse(
        "near_field",
        "coulomb.near_field = \"fixed\" and output.budget: the push of a thread of fixed "
        "radius has no energy. Take \"free-surface\", or remove output.budget");
  constexpr double shortest = 6; // radii
  if (c.nozzle && c.nozzle->inflow == InflowKind::pump && !softens_pairs(c)
      && c.nozzle->link_length < shortest * c.nozzle->radius)
    refuse(
        "softened_pairs",
        fmt::format(
            "nozzle.inflow = \"pump\", nozzle.link_length = {} m and nozzle.radius = {} m: "
            "point charges this close collapse. Take links of at least {} radii, or "
            "coulomb.near_field = \"free-surface\" with softened pairs",
            c.nozzle->link_length, c.nozzle->radius, shortest));
}

void check_coulomb(const SceneConfig& c, const SceneText& text) {
  if (!c.coulomb) return;
  const CoulombConfig& s = *c.coulomb;
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("coulomb.{}", key), why);
  };
  check_near_field(c, refuse);
  const bool expands = s.solver != "direct";
  const auto needs_expansions = [&](const char* key, bool given) {
    if (given && !expands)
      refuse(key, fmt::format(
                      "coulomb.{} and coulomb.solver = \"direct\": the direct sum has no "
                      "expansions. Remove one",
                      key));
  };
  needs_expansions("order", s.order.has_value());
  needs_expansions("opening", s.opening.has_value());
  needs_expansions("leaf", s.leaf.has_value());
  if (s.leaf && *s.leaf % 8 != 0)
    refuse("leaf", fmt::format("coulomb.leaf = {}: must be a multiple of 8", *s.leaf));
  if (s.calibration && s.solver != "auto")
    refuse("calibration",
           fmt::format(
               "coulomb.calibration and coulomb.solver = \"{}\": only \"auto\" chooses "
               "by costs. Remove one",
               s.solver));
}

void check_refinement(const SceneConfig& c, const SceneText& text) {
  if (!c.refinement) return;
  const RefinementConfig& r = *c.refinement;
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("refinement.{}", key), why);
  };
  if (c.nozzle && r.length < 2 * c.nozzle->link_length)
    refuse(
        "length",
        fmt::format("refinement.length = {} m and nozzle.link_length = {} m: must be at "
                    "least twice that, the length of the link that is being fed. Lengths "
                    "are in metres",
                    r.length, c.nozzle->link_length));
  const bool cuts = r.mesh == RefinedMesh::cut;
  if (!r.interval && !cuts)
    text.fail("refinement",
              "refinement.interval is missing: it is needed with mesh = \"redistribute\"; "
              "mesh = \"cut\" does without");
  if (r.interval && *r.interval >= c.run.end_time * (1 + 1e-9))
    refuse("interval",
           fmt::format("refinement.interval = {} s and run.end_time = {} s: no refinement "
                       "would happen",
                       *r.interval, c.run.end_time));
  const RefinementConfig usual;
  const auto is_of_redistribution = [&](const char* key, bool given) {
    if (cuts && given)
      refuse(key,
             fmt::format("refinement.{} has no meaning with mesh = \"cut\": links that "
                         "are cut share out what they carry. Remove it",
                         key));
  };
  is_of_redistribution("remap", r.remap != usual.remap);
  is_of_redistribution("velocity", r.velocity != usual.velocity);
  is_of_redistribution("stress", r.stress.has_value());
  if (r.coarsen && *r.coarsen > r.length / 2)
    refuse(
        "coarsen",
        fmt::format("refinement.coarsen = {} m: must be at most {} m, half of "
                    "refinement.length, or links would be joined that have just been cut",
                    *r.coarsen, r.length / 2));
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
  // Volumes of real solutions do not add up exactly.
  constexpr double tolerated = 0.1;
  const double density = e.solution().density();
  if (c.nozzle && std::abs(c.nozzle->density / density - 1) > tolerated)
    text.fail("nozzle.density",
              fmt::format(
                  "nozzle.density = {} kg/m^3, and a solution of [evaporation] has {:.4g} "
                  "kg/m^3: must agree within {:.0f} %",
                  c.nozzle->density, density, 100 * tolerated));
  if (c.output.budget)
    text.fail("output.budget",
              "output.budget and [evaporation]: a budget does not know what vapour takes "
              "away. Remove one");
}

void check_varicosity(const SceneConfig& c, const SceneText& text) {
  if (!c.varicosity) return;
  if (!c.nozzle)
    text.fail("varicosity", "[varicosity] needs [nozzle]: no bead is born without one");
  if (c.nozzle->inflow == InflowKind::pump)
    text.fail("varicosity",
              "[varicosity] and nozzle.inflow = \"pump\": a pump feeds a uniform fluid. "
              "Remove one");
  if (!c.varicosity->mass && !c.varicosity->volume && !c.varicosity->charge)
    text.fail("varicosity",
              "varicosity.mass, varicosity.volume and varicosity.charge are all "
              "false: nothing would differ. Remove [varicosity]");
}

void check_array(const SceneConfig& c, const SceneText& text) {
  if (!c.array) return;
  const ArrayConfig& a = *c.array;
  if (!c.nozzle)
    text.fail("array", "[array] needs [nozzle]: its jets are born at nozzles. A scene with "
                       "[chain] has one chain");
  if (!c.coulomb)
    text.fail("array", "[array] needs [coulomb]: without it its jets are single jets");
  const double width = 2 * (c.nozzle->radius + c.nozzle->amplitude);
  if (a.jets() > 1 && a.spacing < width)
    text.fail(
        "array.spacing",
        fmt::format("array.spacing = {} m: must be at least {} m, twice nozzle.radius "
                    "+ nozzle.amplitude, or nozzles would overlap",
                    a.spacing, width));
  if (c.integrator.method == "two-rate")
    text.fail("integrator.method",
              "integrator.method = \"two-rate\" and [array]: all jets of an array take "
              "common steps of one rate. Take \"auto\" (the default)");
  const auto refuse = [&](const char* key, bool given, const char* why) {
    if (given) text.fail(key, fmt::format("{} and [array]: {}", key, why));
  };
  refuse("collector.images", has_images(c),
         "a jet would feel the images of its own charges only. Remove one");
  refuse("collector.charge",
         c.collector && c.collector->charge == CollectorCharge::kept_on_mat,
         "a jet would feel its own fibre only. Take \"grounded\" (the default)");
  refuse("output.budget", c.output.budget.has_value(),
         "a budget is that of a single jet. Remove one");
  refuse("output.resolving_power", c.output.resolving_power.has_value(),
         "the resolving power is sampled along a single jet. Remove one");
  refuse("output.refinements", c.output.refinements == RefinementRecords::energies,
         "the energy of the pairs is that of all jets together. Take \"sums\"");
}

void check_output(const SceneConfig& c, const SceneText& text) {
  for (const auto& [name, interval] : {std::pair{"observables", c.output.observables},
                                       {"frames", c.output.frames},
                                       {"budget", c.output.budget},
                                       {"checkpoints", c.output.checkpoints},
                                       {"resolving_power", c.output.resolving_power}})
    if (interval && c.run.end_time / *interval > most_rows)
      text.fail(
          fmt::format("output.{}", name),
          fmt::format(
              "output.{} = {} s and run.end_time = {} s: {:.2g} rows, more than {:.0e}",
              name, *interval, c.run.end_time, c.run.end_time / *interval, most_rows));
  if (c.output.deposit && !c.collector)
    text.fail("output.deposit",
              "output.deposit = true needs [collector]: nothing is deposited "
              "without one");
  if (c.output.refinements != RefinementRecords::none && !c.refinement)
    text.fail("output.refinements",
              fmt::format("output.refinements = \"{}\" needs [refinement]",
                          name_of(c.output.refinements, refinement_records)));
  if (c.output.refinements == RefinementRecords::energies && !c.coulomb)
    text.fail("output.refinements",
              "output.refinements = \"energies\" needs [coulomb]: \"sums\" has all other "
              "energies");
  if (c.output.resolving_power && !c.nozzle)
    text.fail(
        "output.resolving_power",
        fmt::format("output.resolving_power = {} s needs [nozzle]: the resolving power "
                    "is relative to its link_length",
                    *c.output.resolving_power));
}

} // namespace

void settle(SceneConfig& config, const SceneText& text) {
  if (config.viscoelasticity) RheologyCheck(config, text).run();
  check_stress_keys(config, text);
  check_jet(config, text);
  check_field(config, text);
  check_waveform(config, text);
  check_collector(config, text);
  settle_step(config.integrator, text);
  check_adaptive_keys(config.integrator, text);
  check_two_rates(config, text);
  if (config.integrator.stress_scale && !config.viscoelasticity)
    text.fail(
        "integrator.stress_scale",
        fmt::format("integrator.stress_scale = {} Pa needs [viscoelasticity]: without it "
                    "there is no stress",
                    *config.integrator.stress_scale));
  check_coulomb(config, text);
  check_refinement(config, text);
  check_air(config, text);
  check_evaporation(config, text);
  check_varicosity(config, text);
  check_array(config, text);
  check_output(config, text);
}

void check_chain_fits(const Scene& scene, const SceneText& text) {
  if (const auto lost = scene.chain.others.find(evaporated);
      lost != scene.chain.others.end()) {
    const auto& drying = scene.config.evaporation;
    constexpr double overshoot = 1e-3; // of the steps of an earlier run
    const double most =
        drying ? drying->solution().lost_at(drying->solid_fraction) + overshoot : 0.0;
    for (std::size_t k = 0; k < lost->second.values.size(); ++k)
      if (const double e = lost->second.values[k]; !(e >= 0 && e <= most))
        text.fail("chain.file",
                  fmt::format(
                      "{} = {} of bead {} of {}: must be {}", evaporated, e, k,
                      scene.config.chain->file,
                      drying
                          ? fmt::format("from 0 to {:.6g}, where the jet is solid", most)
                          : "0 in a scene without [evaporation]: the volumes and masses of "
                            "the file are those at the nozzle"));
  }
  if (!scene.config.collector) return;
  const double h = scene.config.collector->distance;
  const auto& x = scene.chain.x;
  const auto beyond = std::ranges::find_if(x, [h](double at) { return at > h; });
  if (beyond != x.end())
    text.fail("collector.distance",
              fmt::format(
                  "collector.distance = {} m, and bead {} of {} is at x = {} m, beyond it",
                  h, beyond - x.begin(), scene.config.chain->file, *beyond));
}

void check_stability(const Scene& scene, const SceneText& text) {
  const IntegratorConfig& i = scene.config.integrator;
  if (i.step || integration_method(i.method).kind != MethodKind::explicit_steps) return;
  const LinkState link = link_state(scene, stiffest_link(scene));
  const ChainRates rates = chain_rates(scene.config, link);
  const StabilityLimits limits = step_limits(rates, butcher_tableau(i.method));
  const double unlimited = std::numeric_limits<double>::infinity();
  const double viscoelastic = limits.viscoelastic.value_or(unlimited),
               damping = limits.damping.value_or(unlimited),
               tension = limits.surface_tension.value_or(unlimited),
               limit = std::min({viscoelastic, damping, tension});
  const double steps = scene.config.run.end_time / limit;
  const double motion = 1 / rates.coulomb.value_or(0); // infinite without charges
  const bool far_below_accuracy =
      std::isfinite(motion) && limit < far_below * motion && steps > many_steps;
  if (steps <= too_many_steps && !far_below_accuracy) return;

  std::string reason;
  if (damping < std::min(viscoelastic, tension))
    reason = fmt::format("viscosity damps links of {:.3g} m at {:.3g} 1/s", link.length,
                         *rates.damping);
  else if (tension < viscoelastic)
    reason = fmt::format("surface tension moves links of {:.3g} m at {:.3g} 1/s",
                         link.length, *rates.surface_tension);
  else if (rates.relaxation.value_or(0) > *rates.elastic)
    reason = fmt::format("stress relaxes at G/mu = {:.3g} 1/s", *rates.relaxation);
  else
    reason = fmt::format("elastic waves turn links of {:.3g} m around at {:.3g} 1/s",
                         link.length, *rates.elastic);
  text.fail("integrator.method",
            fmt::format("integrator.method = \"{}\": {}, so that explicit steps are stable "
                        "up to about {:.2g} s only and {:.4g} s take {:.1e} of them. Take "
                        "integrator.method = \"auto\" (the default) or \"ros34pw2\", whose "
                        "steps this does not limit",
                        i.method, reason, limit, scene.config.run.end_time, steps));
}

} // namespace ehdjet
