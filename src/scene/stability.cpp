#include "ehdjet/scene/stability.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/integrators/stability_region.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace ehdjet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double zeta_3 = 1.2020569031595942854; // Apery's constant, OEIS A002117

double limit_of_oscillation(const ButcherTableau& method, double rate) {
  return longest_stable_step(method, {0, rate});
}

/// The least limit over the modes of the Maxwell chain, kappa from 0 (pure relaxation) to pi.
double viscoelastic_limit(const ButcherTableau& method, double relaxation, double elastic) {
  if (std::isinf(relaxation)) return 0;
  constexpr int modes = 64;
  double limit = longest_stable_step(method, -relaxation);
  for (int i = 1; i <= modes; ++i) {
    const double omega = elastic * std::sin(0.5 * std::numbers::pi * i / modes);
    const double decay = 0.5 * relaxation,
                 scale = std::max(decay, omega); // squares may overflow
    const std::complex<double> root = std::sqrt(
        std::complex<double>((decay - omega) / scale * ((decay + omega) / scale)));
    // The faster root; in an overdamped mode the other one is slower and real.
    limit = std::min(limit, longest_stable_step(method, -decay - scale * root));
  }
  return limit;
}

void add_viscoelastic_rates(const ViscoelasticityConfig& fluid, const LinkState& link,
                            ChainRates& rates) {
  const double l = link.length, rho = link.density;
  const double G = fluid.elastic_modulus.value_or(0), mu = fluid.viscosity.value_or(0);
  const auto elastic = [&](double modulus) { return 2 * std::sqrt(modulus / rho) / l; };
  const auto viscous = [&](double viscosity) { return 4 * viscosity / (rho * l * l); };
  if (const double eta = fluid.instant_viscosity(); eta > 0) rates.damping = viscous(eta);
  if (fluid.model == Rheology::kelvin_voigt) {
    if (G > 0) rates.elastic = elastic(G);
  } else if (fluid.is_tensorial()) {
    double modulus = 0, viscosity = 0;
    for (const RelaxationMode& m : fluid.relaxation_modes()) {
      modulus += m.modulus, viscosity += m.modulus * m.relaxation_time;
      rates.relaxation = std::max(rates.relaxation.value_or(0), 1 / m.relaxation_time);
    }
    if (modulus > 0)
      rates.elastic = elastic(3 * modulus), rates.viscous = viscous(3 * viscosity);
  } else if (G > 0 && mu > 0) {
    rates.relaxation = G / mu, rates.elastic = elastic(G), rates.viscous = viscous(mu);
  }
}

} // namespace

ChainRates chain_rates(const SceneConfig& config, const LinkState& link) {
  const auto& [l, a, rho, rho_q] = link;
  EHDJET_EXPECTS(l > 0 && a > 0 && rho > 0);
  ChainRates rates;
  if (config.viscoelasticity) add_viscoelastic_rates(*config.viscoelasticity, link, rates);
  if (config.coulomb) {
    const double gamma =
        std::abs(rho_q) * std::sqrt(std::numbers::pi * constants::coulomb / rho) * a / l;
    rates.coulomb = std::sqrt(7 * zeta_3) * gamma;
    rates.coulomb_growth = std::sqrt(3.5 * zeta_3) * gamma;
  }
  if (const auto& tension = config.surface_tension)
    rates.surface_tension = tension->form == SurfaceTensionForm::paper
                                ? 2 * std::sqrt(tension->coefficient / (rho * l * l * l))
                                : 2 * std::sqrt(tension->coefficient / (rho * a)) / l;
  return rates;
}

StabilityLimits step_limits(const ChainRates& rates, const ButcherTableau& method) {
  StabilityLimits limits;
  if (rates.relaxation)
    limits.viscoelastic = viscoelastic_limit(method, *rates.relaxation, *rates.elastic);
  else if (rates.elastic)
    limits.viscoelastic = limit_of_oscillation(method, *rates.elastic);
  if (rates.damping) limits.damping = longest_stable_step(method, -*rates.damping);
  if (rates.coulomb) limits.coulomb = limit_of_oscillation(method, *rates.coulomb);
  if (rates.surface_tension)
    limits.surface_tension = limit_of_oscillation(method, *rates.surface_tension);
  return limits;
}

double StabilityLimits::least() const {
  return std::min({viscoelastic.value_or(infinity), damping.value_or(infinity),
                   coulomb.value_or(infinity), surface_tension.value_or(infinity)});
}

std::optional<std::string> step_warning(const Scene& scene) {
  const IntegratorConfig& i = scene.config.integrator;
  if (!i.step || integration_method(i.method).kind != MethodKind::explicit_steps)
    return std::nullopt;
  const std::size_t k = stiffest_link(scene);
  const double limit = step_limits(chain_rates(scene.config, link_state(scene, k)),
                                   butcher_tableau(i.method))
                           .least();
  if (*i.step <= limit) return std::nullopt;
  return fmt::format(
      "integrator.step = {} s is longer than {:.4g} s, the longest stable step "
      "of {} for {}: the jet will be wrong, or the run will blow up",
      *i.step, limit, i.method,
      scene.config.nozzle ? "the link that leaves the nozzle" : fmt::format("link {}", k));
}

LinkState link_state(const Scene& scene, std::size_t k) {
  if (const auto& n = scene.config.nozzle)
    return {n->link_length, n->radius, n->density, n->fluid_charge_density()};
  const ChainBeads& b = scene.chain;
  EHDJET_EXPECTS(k >= 1 && k < b.size());
  const double l =
      std::hypot(b.x[k] - b.x[k - 1], b.y[k] - b.y[k - 1], b.z[k] - b.z[k - 1]);
  return {l, std::sqrt(b.volume[k] / (std::numbers::pi * l)), b.mass[k] / b.volume[k],
          b.charge[k] / b.volume[k]};
}

std::size_t stiffest_link(const Scene& scene) {
  std::size_t stiffest = 1;
  double fastest = 0;
  for (std::size_t k = 1; k < scene.chain.size(); ++k) {
    const ChainRates r = chain_rates(scene.config, link_state(scene, k));
    const double rate = std::max({r.elastic.value_or(0), r.damping.value_or(0),
                                  r.coulomb.value_or(0), r.surface_tension.value_or(0)});
    if (rate > fastest) fastest = rate, stiffest = k;
  }
  return stiffest;
}

} // namespace ehdjet
