#pragma once

#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/scene/read_scene.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace ehdjet {

/// One link of a uniform straight chain, to which the rates below belong.
struct LinkState {
  double length = 0;         ///< l [m]
  double radius = 0;         ///< a [m]
  double density = 0;        ///< rho [kg/m^3]
  double charge_density = 0; ///< rho_q [C/m^3]
};

/// Fastest rates of the linearised chain, for the terms that the scene has [1/s].
///
///     relaxation      1/tau = G/mu; with modes the fastest
///     elastic         omega_el = 2 sqrt(G/rho) / l; a stress tensor has three times the sum of its G
///     viscous         4 mu / (rho l^2), with 3 mu for a stress tensor: after relaxation
///     damping         4 eta / (rho l^2), eta = 3 mu_s or mu of a Kelvin-Voigt body: at once
///     Coulomb         sqrt(7 zeta(3)) Gamma = 2.901 Gamma,   Gamma = rho_q sqrt(pi k_C/rho) a/l
///     growth          sqrt(7 zeta(3)/2) Gamma = 2.051 Gamma  (bending instability: not stiff)
///     surface tension paper: 2 sqrt(alpha/(rho l^3))         line: 2 sqrt(alpha/(rho a)) / l
///
/// source : longitudinal and transverse modes of an infinite chain in which neighbours move in
///          opposite phase; the Coulomb sums are 8 sum 1/j^3 over odd j = 7 zeta(3)
/// checked: Stability tests, against a table computed independently
struct ChainRates {
  std::optional<double> relaxation, elastic, viscous, damping;
  std::optional<double> coulomb, coulomb_growth;
  std::optional<double> surface_tension;
};
ChainRates chain_rates(const SceneConfig& config, const LinkState& link);

/// Longest stable step of an explicit method, per term; infinite if a term that
/// the scene has limits nothing (no charge, say) [s].
///
/// The viscoelastic limit is the least over the modes s^2 + s/tau + (omega_el sin(kappa/2))^2 = 0.
struct StabilityLimits {
  std::optional<double> viscoelastic, damping, coulomb, surface_tension;

  [[nodiscard]] double least() const; ///< infinite if no term limits the step
};
StabilityLimits step_limits(const ChainRates& rates,
                            const ButcherTableau& method = butcher_tableau("rk4"));

/// What to say of a fixed step of an explicit method that is longer than the stable one; else nothing.
std::optional<std::string> step_warning(const Scene& scene);

/// Link k of a chain scene, or (k = 1) the link that leaves the nozzle.
LinkState link_state(const Scene& scene, std::size_t k = 1);

/// The link of a chain scene with the fastest elastic, Coulomb or surface-tension rate
/// (relaxation is the same everywhere); 1 for a nozzle scene.
std::size_t stiffest_link(const Scene& scene);

} // namespace ehdjet
