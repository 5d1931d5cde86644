#include "physics_report.hpp"

#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {
namespace {

constexpr double vacuum_permittivity = 8.8541878128e-12; // [F/m]
constexpr double breakdown_of_air = 3e6;                 // [V/m]
constexpr double thread_limit = 4; // radii: l > e^1.384 a, see model 3.1

/// lambda/(2 pi eps0 a) with lambda = rho_q pi a^2 [V/m].
double surface_field(const NozzleConfig& n) {
  return std::abs(n.fluid_charge_density()) * n.radius / (2 * vacuum_permittivity);
}

/// (a/a_R)^3, a_R = (8 eps0 alpha/rho_q^2)^(1/3): electrostatic over capillary pressure.
double rayleigh_ratio(const NozzleConfig& n, double surface_tension) {
  const double rho_q = n.fluid_charge_density();
  return n.radius * n.radius * n.radius * rho_q * rho_q
         / (8 * vacuum_permittivity * surface_tension);
}

/// The shortest of the first links: that of a pump after a cut [m].
double shortest_first_link(const NozzleConfig& n) {
  return n.inflow == InflowKind::pump ? n.link_length / 2 : n.link_length;
}

/// How long a bead that leaves the nozzle with the fluid takes to the collector if only field and gravity
/// pull at it; none if the air slows it down [s].
std::optional<double> flight_time(const SceneConfig& c) {
  if (!c.nozzle || !c.collector || c.air) return std::nullopt;
  const double a = c.nozzle->fluid_charge_density() / c.nozzle->density * field_strength(c)
                   + (c.gravity ? c.gravity->acceleration : 0);
  if (!(a > 0)) return std::nullopt;
  const double v = c.nozzle->fluid_velocity();
  return (std::sqrt(v * v + 2 * a * c.collector->distance) - v) / a;
}

/// Cost of the beads and the images that act on them, over that of the beads (model 3.2). The direct sum of
/// the beads takes each pair once; images feel nothing, so that theirs cannot.
double sums_per_evaluation(const SceneConfig& c) {
  if (!has_images(c)) return 1;
  return c.collector->images == CollectorImages::plates ? 25 : 3;
}

/// Whether a run with so many beads takes two rates.
bool takes_two_rates(const SceneConfig& c, double beads) {
  constexpr double worth_it = 200; // for `auto`
  return can_have_two_rates(c) && (c.integrator.method == "two-rate" || beads >= worth_it);
}

std::string nozzle_text(const SceneConfig& c) {
  const NozzleConfig& n = *c.nozzle;
  std::string text;
  const auto say = [&text](bool is_warning, const std::string& what) {
    text += fmt::format("  {}{}\n", is_warning ? "WARNING: " : "", what);
  };
  const bool has_charge = n.fluid_charge_density() != 0;
  if (has_charge) {
    const double field = surface_field(n);
    say(field > breakdown_of_air,
        fmt::format(
            "field at the surface of the jet at the nozzle {:.3g} V/m; air breaks down "
            "at {:.0e} V/m",
            field, breakdown_of_air));
  }
  if (has_charge && c.surface_tension && c.surface_tension->coefficient > 0) {
    const double ratio = rayleigh_ratio(n, c.surface_tension->coefficient);
    say(ratio > 1,
        fmt::format(
            "electrostatic over capillary pressure at the nozzle {:.3g}; above 1 a jet "
            "may branch, which a single chain cannot show",
            ratio));
  }
  if (const double field = std::abs(field_strength(c)); n.conductivity && field > 0) {
    // Charge moves with the fluid where the current that it can conduct is small: a < a*.
    const double current = std::abs(*n.flow_rate * n.fluid_charge_density());
    say(false,
        fmt::format(
            "conduction ends where the jet is thinner than sqrt(I/(pi K E)) = {:.3g} m",
            std::sqrt(current / (std::numbers::pi * *n.conductivity * field))));
  }
  if (n.inflow == InflowKind::pump && n.link_length > n.radius)
    say(false,
        fmt::format("nozzle.link_length = {} m is longer than nozzle.radius = {} m: near "
                    "the nozzle a jet converges only with links that are at most as long "
                    "as its radius",
                    n.link_length, n.radius));
  return text;
}

} // namespace

std::vector<std::string> near_field_warnings(const SceneConfig& c) {
  std::vector<std::string> warnings;
  if (!has_near_field(c)) return warnings;
  if (c.surface_tension && c.surface_tension->form == SurfaceTensionForm::paper)
    warnings.emplace_back("coulomb.near_field with surface_tension.form = \"paper\": on "
                          "long links that form is a "
                          "small part of the real tension. Take form = \"line\"");
  if (c.nozzle && !softens_pairs(c)
      && shortest_first_link(*c.nozzle) < thread_limit * c.nozzle->radius)
    warnings.push_back(
        fmt::format("nozzle.link_length = {} m makes links of less than {} radii: the near "
                    "field of point "
                    "pairs pulls such links together. Take coulomb.softened_pairs = true",
                    c.nozzle->link_length, thread_limit));
  return warnings;
}

std::string physics_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  std::string text;
  if (c.nozzle) text = nozzle_text(c);
  for (const std::string& warning : near_field_warnings(c))
    text += fmt::format("  WARNING: {}\n", warning);
  return text.empty() ? text : "\nPhysics\n" + text;
}

std::string cost_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  const auto flight = flight_time(c);
  if (!flight || !c.integrator.rtol || c.nozzle->inflow != InflowKind::pump) return "";
  const double cuts_per_second =
      *c.nozzle->flow_rate / (c.nozzle->section() * c.nozzle->link_length);
  double beads = cuts_per_second * *flight;
  if (c.refinement) beads = std::max(beads, c.collector->distance / c.refinement->length);
  const double jets = c.array ? static_cast<double>(c.array->jets()) : 1;
  beads *= jets;
  std::string text = fmt::format(
      "\nCost, rough estimates\n  beads         {:.0f}, those of {} without mutual "
      "repulsion{}\n",
      beads, c.array ? "straight jets" : "a straight jet",
      c.refinement ? "; refinement of a whipping jet adds to them" : "");
  // 38 to 78 between cuts at rtol 1e-5 (scenes/converged.toml, five lengths of links); steps of a
  // fifth-order pair get shorter with the fifth root of rtol.
  const double evaluations =
      50 * std::pow(1e-5 / *c.integrator.rtol, 0.2) * cuts_per_second * c.run.end_time;
  text += fmt::format("  evaluations   {:.1e}\n", evaluations);
  if (c.coulomb && c.coulomb->solver != "treecode") { // for which there is no table
    const CoulombConfig& s = *c.coulomb;
    const auto n = static_cast<std::size_t>(std::max(beads, 2.0));
    const CostModel& costs = scene.costs ? *scene.costs : CostModel::shipped();
    const std::string_view solver =
        s.solver == "auto" ? costs.cheapest(n, s.tolerance) : std::string_view(s.solver);
    text += fmt::format(
        "  wall time     {:.2g} s on one core{}\n",
        evaluations * costs.cost(solver, n, s.tolerance) * sums_per_evaluation(c),
        takes_two_rates(c, beads) ? " if all steps had one rate; two rates take less" : "");
  }
  if (c.output.frames) {
    constexpr double columns = 14; // place, velocity, stress, radius, contents, marks
    text += fmt::format("  run file      {:.3g} MB of frames\n",
                        8e-6 * columns * beads * c.run.end_time / *c.output.frames);
  }
  return text;
}

} // namespace ehdjet
