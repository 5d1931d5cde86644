#include "ehdjet/scene/scene_report.hpp"

#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/schema.hpp"
#include "ehdjet/scene/stability.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <utility>

#include "physics_report.hpp"

namespace ehdjet {
namespace {

std::string groups_text(const SceneConfig& config) {
  const auto g = dimensionless_groups(config);
  if (!g) return "";
  std::string text =
      fmt::format("\nDimensionless groups (Reneker et al. 2000; Lauricella et al. "
                  "2015)\n  unit of length L0  {:.10g} m\n  unit of time tau   "
                  "{:.10g} s\n",
                  g->length, g->time);
  const auto line = [&text](const char* symbol, std::optional<double> value,
                            const char* meaning) {
    if (value) text += fmt::format("  {:<5} {:<16.10g} {}\n", symbol, *value, meaning);
  };
  line("Q", config.coulomb ? std::optional(g->coulomb) : std::nullopt, "Coulomb force");
  line("Phi", g->field, "external field");
  line("Fve", g->viscoelastic, "viscoelastic force");
  line("Fve'", g->viscoelastic_jetspin, "the same, radii in units of L0");
  line("A", g->surface_tension, "surface tension");
  line("Ks", g->nozzle_motion, "motion of the nozzle");
  line("H", g->collector, "distance of the collector");
  line("Fg", g->gravity, "gravity");
  return text;
}

std::string stability_text(const Scene& scene) {
  const std::size_t k = stiffest_link(scene);
  const LinkState link = link_state(scene, k);
  const ChainRates rates = chain_rates(scene.config, link);
  const StabilityLimits limits = step_limits(rates);
  if (!rates.elastic && !rates.damping && !rates.coulomb && !rates.surface_tension)
    return "";
  std::string text = fmt::format(
      "\nFastest rates of a uniform chain like {} (l = {:.6g} m, a = {:.6g} m), and the "
      "longest stable step of rk4\n",
      scene.config.nozzle ? "the link that leaves the nozzle" : fmt::format("link {}", k),
      link.length, link.radius);
  const auto line = [&text](const char* term, std::optional<double> rate,
                            std::optional<double> step) {
    if (!rate) return;
    text += fmt::format("  {:<24} {:>10.4g} 1/s", term, *rate);
    if (step && std::isfinite(*step)) text += fmt::format("   {:>10.4g} s", *step);
    text += '\n';
  };
  line("relaxation 1/tau", rates.relaxation, {});
  line("viscous 4mu/(rho l^2)", rates.viscous, {});
  line("elastic", rates.elastic, limits.viscoelastic);
  line("damping", rates.damping, limits.damping);
  line("Coulomb", rates.coulomb, limits.coulomb);
  line("bending growth", rates.coulomb_growth, {});
  line("surface tension", rates.surface_tension, limits.surface_tension);
  if (const auto warning = step_warning(scene))
    text += fmt::format("  WARNING: {}\n", *warning);
  return text;
}

std::string coulomb_text(const Scene& scene) {
  const CoulombConfig& c = *scene.config.coulomb;
  if (c.solver == "direct") return "direct";
  std::string text = fmt::format("{}, tolerance {:g}", c.solver, c.tolerance);
  if (c.solver != "auto") return text;
  const CostModel& costs = scene.costs ? *scene.costs : CostModel::shipped();
  const std::size_t n = costs.crossover(c.tolerance);
  return text
         + fmt::format(": direct below {} beads, {} from there on, by the {} costs", n,
                       costs.cheapest(n, c.tolerance),
                       scene.costs ? "measured" : "shipped");
}

std::string air_text(const AirConfig& air) {
  std::string moving;
  if (air.velocity)
    moving = fmt::format(", wind of {:g}, {:g}, {:g} m/s", (*air.velocity)[0],
                         (*air.velocity)[1], (*air.velocity)[2]);
  if (air.profile) moving = ", wind of " + *air.profile;
  return fmt::format("drag of the air ({}{}{})", name_of(air.drag, drag_laws),
                     air.lift ? ", with lift" : "", moving);
}

std::string rheology_text(const SceneConfig& c) {
  const ViscoelasticityConfig& fluid = *c.viscoelasticity;
  if (!carries_stress(c)) return "viscoelasticity (inviscid: the stress is 0)";
  if (fluid.model == Rheology::maxwell) return "viscoelasticity (Maxwell)";
  const std::size_t modes = fluid.relaxation_modes().size();
  return fmt::format("viscoelasticity ({}{})", name_of(fluid.model, rheologies),
                     modes > 1 ? fmt::format(", {} modes", modes) : "");
}

std::string waveform_text(const FieldConfig& c) {
  if (c.waveform == FieldWaveform::square)
    return fmt::format(" (square wave of {:.6g} 1/s)", *c.frequency);
  if (c.waveform == FieldWaveform::rc)
    return fmt::format(" (rises within {:.6g} s)", *c.time_constant);
  return "";
}

std::string forces_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  std::vector<std::string> forces;
  if (c.field)
    forces.push_back(fmt::format("external field {:.6g} V/m{}", field_strength(c),
                                 waveform_text(*c.field)));
  if (c.gravity)
    forces.push_back(fmt::format("gravity {:.6g} m/s^2", c.gravity->acceleration));
  if (c.coulomb) forces.push_back(fmt::format("Coulomb ({})", coulomb_text(scene)));
  if (has_nozzle_charge(c)) forces.emplace_back("charge in the nozzle");
  if (has_images(c))
    forces.push_back(
        fmt::format("images ({})", name_of(c.collector->images, collector_images)));
  if (has_near_field(c))
    forces.push_back(fmt::format("near field ({}{})",
                                 name_of(c.coulomb->near_field, near_field_forms),
                                 softens_pairs(c) ? ", softened pairs" : ""));
  if (c.air) forces.push_back(air_text(*c.air));
  if (c.evaporation)
    forces.push_back(fmt::format("evaporation from {:g} to {:g} of polymer",
                                 c.evaporation->polymer_fraction,
                                 c.evaporation->solid_fraction));
  if (c.viscoelasticity) forces.push_back(rheology_text(c));
  if (c.surface_tension)
    forces.push_back(fmt::format("surface tension ({} form)",
                                 name_of(c.surface_tension->form, surface_tension_forms)));
  return forces.empty() ? "none: beads move in straight lines"
                        : fmt::format("{}", fmt::join(forces, ", "));
}

std::string output_text(const SceneConfig& c) {
  const auto rows = [&c](double interval) {
    // The row at t = 0 and one at every multiple; round-off must not lose the last.
    return std::floor(c.run.end_time / interval * (1 + 1e-12)) + 1;
  };
  std::vector<std::string> parts;
  if (c.output.observables)
    parts.push_back(fmt::format("{} rows of observables", rows(*c.output.observables)));
  if (c.output.frames)
    parts.push_back(fmt::format("{} frames of all beads", rows(*c.output.frames)));
  if (c.output.budget)
    parts.push_back(fmt::format("{} rows of energy and momentum", rows(*c.output.budget)));
  if (c.output.resolving_power)
    parts.push_back(
        fmt::format("{} samples of the resolving power", rows(*c.output.resolving_power)));
  if (c.output.refinements != RefinementRecords::none)
    parts.emplace_back("a record of each refinement");
  if (c.output.deposit) parts.emplace_back("every bead that leaves at the collector");
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

/// What is to happen so often that the run would do little else.
std::vector<std::string> interval_warnings(const SceneConfig& c) {
  constexpr double many = 1e6;
  std::vector<std::string> warnings;
  for (const auto& [key, interval] :
       {std::pair{"output.observables", c.output.observables},
        {"output.frames", c.output.frames},
        {"output.budget", c.output.budget},
        {"output.resolving_power", c.output.resolving_power},
        {"output.checkpoints", c.output.checkpoints},
        {"refinement.interval",
         c.refinement ? c.refinement->interval : std::optional<double>()}})
    if (interval && c.run.end_time / *interval > many)
      warnings.push_back(fmt::format("{} = {} s is {:.1e} times in run.end_time = {} s",
                                     key, *interval, c.run.end_time / *interval,
                                     c.run.end_time));
  return warnings;
}

std::string jet_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  if (!c.nozzle)
    return fmt::format("a chain of {} beads from {}, fixed ends: {}; nothing is inserted",
                       scene.chain.size(), c.chain->file,
                       name_of(c.chain->fixed, fixed_ends));
  if (c.nozzle->inflow == InflowKind::pump)
    return fmt::format(
        "fed by a pump at {:.6g} m^3/s and {:.6g} A; v_s = {:.6g} m/s, a new "
        "bead every {:.4g} s",
        *c.nozzle->flow_rate, *c.nozzle->flow_rate * c.nozzle->fluid_charge_density(),
        c.nozzle->fluid_velocity(),
        c.nozzle->section() * c.nozzle->link_length / *c.nozzle->flow_rate);
  return "born at the nozzle: a link that reaches 1.5 link lengths gets a new bead, "
         "released at 2 "
         "link lengths";
}

std::string array_text(const ArrayConfig& a) {
  return fmt::format(
      "  array: {} such jets, {} x {} nozzles at {} m, phases: {}; all charges act on each "
      "other\n",
      a.jets(), a.rows, a.columns, a.spacing, name_of(a.phases, array_phases));
}

std::string refinement_text(const SceneConfig& c) {
  const RefinementConfig& r = *c.refinement;
  const std::string when =
      r.interval ? fmt::format("every {} s", *r.interval) : "at the end of every step";
  std::string text =
      r.mesh == RefinedMesh::cut
          ? fmt::format("  refinement: {}, links longer than {} m are cut", when, r.length)
          : fmt::format("  refinement: {}, where links are longer than {} m; {} remap",
                        when, r.length, name_of(r.remap, refinement_remaps));
  if (r.shortest) text += fmt::format("; links below {} radii are joined", *r.shortest);
  if (r.coarsen) text += fmt::format("; links together below {} m are joined", *r.coarsen);
  return text + '\n';
}

std::string landed_charge_text(const CollectorConfig& c) {
  if (c.charge == CollectorCharge::grounded) return "no longer acts";
  if (c.charge == CollectorCharge::kept) return "acts until it leaves";
  return c.decay_time ? fmt::format("stays and decays within {:.6g} s", *c.decay_time)
                      : "stays and acts";
}

/// Times that follow from single numbers of the scene.
std::string times_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  std::string text;
  const LinkState link = link_state(scene, stiffest_link(scene));
  const double a = link.charge_density / link.density * field_strength(c)
                   + (c.gravity ? c.gravity->acceleration : 0);
  if (a != 0) text += fmt::format("  acceleration by field and gravity {:.6g} m/s^2", a);
  if (a > 0 && c.nozzle && c.collector)
    text += fmt::format("; a lone bead from rest would reach the collector after {:.4g} s",
                        std::sqrt(2 * c.collector->distance / a));
  return text.empty() ? text : text + '\n';
}

std::string run_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  const auto& i = c.integrator;
  std::string text = "\nWhat will be simulated\n";
  text += fmt::format("  jet: {}\n", jet_text(scene));
  if (c.array) text += array_text(*c.array);
  text += fmt::format("  forces: {}\n", forces_text(scene));
  text += c.collector ? fmt::format("  collector: beads land at x = {} m and leave the "
                                    "chain; the charge of a landed bead {}\n",
                                    c.collector->distance, landed_charge_text(*c.collector))
                      : "  collector: none, beads fly on\n";
  if (c.varicosity)
    text += fmt::format(
        "  varicosity: every {}th bead has {} times the{}{}{}\n", c.varicosity->every,
        c.varicosity->factor, c.varicosity->mass ? " mass" : "",
        c.varicosity->volume ? " volume" : "", c.varicosity->charge ? " charge" : "");
  if (c.refinement) text += refinement_text(c);
  text += fmt::format("  time: 0 to {} s, {}, {}", c.run.end_time, i.method,
                      i.step ? fmt::format("step {} s ({:.0f} steps)", *i.step,
                                           std::ceil(c.run.end_time / *i.step))
                             : fmt::format("rtol {}, adaptive", *i.rtol));
  if (c.nozzle || c.collector)
    text += i.events == EventPlacement::located ? "; events located inside steps"
                                                : "; events at the ends of steps";
  text += fmt::format("\n  output: {}\n", output_text(c));
  for (const std::string& warning : interval_warnings(c))
    text += fmt::format("  WARNING: {}\n", warning);
  return text + times_text(scene);
}

} // namespace

std::string scene_report(const Scene& scene) {
  return resolved_toml(scene.config) + groups_text(scene.config) + stability_text(scene)
         + physics_text(scene) + run_text(scene) + cost_text(scene);
}

std::vector<std::string> run_warnings(const Scene& scene) {
  std::vector<std::string> warnings = near_field_warnings(scene.config);
  if (auto warning = step_warning(scene)) warnings.push_back(std::move(*warning));
  std::ranges::move(interval_warnings(scene.config), std::back_inserter(warnings));
  return warnings;
}

} // namespace ehdjet
