#include "physics_report.hpp"

#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <string>
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

/// How long a bead from rest that only field and gravity pull takes to the collector [s].
std::optional<double> flight_time(const SceneConfig& c) {
  if (!c.nozzle || !c.collector) return std::nullopt;
  const double a = c.nozzle->fluid_charge_density() / c.nozzle->density * field_strength(c)
                   + (c.gravity ? c.gravity->acceleration : 0);
  if (!(a > 0)) return std::nullopt;
  const double v = c.nozzle->fluid_velocity();
  return (std::sqrt(v * v + 2 * a * c.collector->distance) - v) / a;
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
      && c.nozzle->link_length < thread_limit * c.nozzle->radius)
    warnings.push_back(fmt::format("nozzle.link_length = {} m is less than {} radii: the "
                                   "near field of point pairs pulls such "
                                   "links together. Take coulomb.softened_pairs = true",
                                   c.nozzle->link_length, thread_limit));
  return warnings;
}

std::string physics_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  if (!c.nozzle) return "";
  const NozzleConfig& n = *c.nozzle;
  std::string text;
  const auto say = [&text](bool is_warning, const std::string& what) {
    text += fmt::format("  {}{}\n", is_warning ? "WARNING: " : "", what);
  };
  if (n.fluid_charge_density() != 0) {
    const double field = surface_field(n);
    say(field > breakdown_of_air,
        fmt::format(
            "field at the surface of the jet at the nozzle {:.3g} V/m; air breaks down "
            "at {:.0e} V/m",
            field, breakdown_of_air));
  }
  if (c.surface_tension && c.surface_tension->coefficient > 0
      && n.fluid_charge_density() != 0) {
    const double ratio = rayleigh_ratio(n, c.surface_tension->coefficient);
    say(ratio > 1,
        fmt::format(
            "electrostatic over capillary pressure at the nozzle {:.3g}; above 1 a jet "
            "may branch, which a single chain cannot show",
            ratio));
  }
  for (const std::string& warning : near_field_warnings(c)) say(true, warning);
  if (const double field = field_strength(c); n.conductivity && field > 0) {
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
  return text.empty() ? text : "\nPhysics\n" + text;
}

std::string cost_text(const Scene& scene) {
  const SceneConfig& c = scene.config;
  const auto flight = flight_time(c);
  if (!flight || !c.integrator.rtol) return "";
  // A straight jet has the fewest beads; a whipping one has several times as many.
  double beads = 0;
  if (c.nozzle->inflow == InflowKind::pump)
    beads = *c.nozzle->flow_rate / (c.nozzle->section() * c.nozzle->link_length) * *flight;
  if (c.refinement) beads = std::max(beads, c.collector->distance / c.refinement->length);
  if (beads < 1) return "";
  std::string text =
      fmt::format("\nCost\n  beads         at least {:.0f}, those of a straight "
                  "jet; a whipping one has several times as many\n",
                  beads);
  if (c.coulomb) {
    const auto n = static_cast<std::size_t>(std::max(beads, 2.0));
    const CostModel& costs = scene.costs ? *scene.costs : CostModel::shipped();
    const std::string solver = c.coulomb->solver == "auto"
                                   ? std::string(costs.cheapest(n, c.coulomb->tolerance))
                                   : c.coulomb->solver;
    if (solver != "treecode")
      text += fmt::format(
          "  evaluation    {:.2g} s of the Coulomb force of so many beads, on one "
          "core\n",
          costs.cost(solver, n, c.coulomb->tolerance));
  }
  if (c.nozzle->inflow == InflowKind::pump) {
    // 38 to 43 between cuts at rtol 1e-5 (scenes/converged.toml, four lengths of links); steps of a
    // fifth-order pair get shorter with the fifth root of rtol.
    const double per_cut = 40 * std::pow(1e-5 / *c.integrator.rtol, 0.2);
    const double cuts = *c.nozzle->flow_rate * c.run.end_time
                        / (c.nozzle->section() * c.nozzle->link_length);
    text += fmt::format("  evaluations   about {:.1e}\n", per_cut * cuts);
  }
  if (c.output.frames) {
    const double columns =
        14; // place, velocity, stress, radius, volume, mass, charge, marks
    text += fmt::format("  run file      at least {:.3g} MB of frames\n",
                        8e-6 * columns * beads * c.run.end_time / *c.output.frames);
  }
  return text;
}

} // namespace ehdjet
