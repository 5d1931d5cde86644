#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>

#include "cross_check_parts.hpp"
#include "key_description.hpp"

namespace ehdjet {
namespace {

/// A key that the scene must give, or must not give.
template <class Refuse, class T>
void need(const Refuse& refuse, const char* key, const std::optional<T>& value,
          const char* with) {
  if (!value)
    refuse("", fmt::format("nozzle.{} is missing: it is needed with {}; {}", key, with,
                           key_description(fmt::format("nozzle.{}", key))));
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

} // namespace

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
      text.fail("field", fmt::format("field.{} is missing: it is needed with {}; {}", key,
                                     is, key_description(fmt::format("field.{}", key))));
    if (waveform != its && value)
      text.fail(fmt::format("field.{}", key),
                fmt::format("field.{} = {} {} has no meaning with {}: it needs waveform = "
                            "\"{}\". Remove it",
                            key, *value, unit, is, name_of(its, field_waveforms)));
  };
  check("frequency", c.field->frequency, "1/s", FieldWaveform::square);
  check("time_constant", c.field->time_constant, "s", FieldWaveform::rc);
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
  if (a.phases == ArrayPhases::spread && (a.jets() == 1 || c.nozzle->amplitude == 0))
    text.fail(
        "array.phases",
        fmt::format(
            "array.phases = \"spread\" has no meaning with {}: no phases differ. Remove it",
            a.jets() == 1 ? "one jet" : "nozzle.amplitude = 0 m"));
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

} // namespace ehdjet
