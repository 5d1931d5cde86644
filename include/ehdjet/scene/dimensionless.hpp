#pragma once

#include "ehdjet/scene/config.hpp"

#include <optional>

namespace ehdjet {

/// Dimensionless groups of a jet from a nozzle. With q, m, a0 the charge, mass and radius of a
/// bead at the nozzle, tau = mu/G (of modes: G and mu are sums) and k_C the Coulomb constant:
///
///     L0  = sqrt(k_C q^2 / (pi a0^2 G))       unit of length; tau is the unit of time
///     Q   = k_C q^2 mu^2 / (L0^3 m G^2)       Coulomb force
///     Phi = q (Phi0/h) mu^2 / (L0 m G^2)      external field
///     Fve = pi a0^2 mu^2 / (m L0 G)           viscoelastic force, Reneker et al.
///     Fve'= L0 mu^2 / (m G)                   the same with lengths, so also radii, in L0: Fve
///                                             without the section pi a0^2/L0^2 (JETSPIN)
///     A   = alpha pi a0^2 mu^2 / (m L0^2 G^2) surface tension
///     Ks  = omega mu / G                      motion of the nozzle
///     H   = h / L0                            distance of the collector
///     Fg  = g mu^2 / (L0 G^2)                 gravity (JETSPIN)
///
/// laws   : Q = Fve, that is how L0 is chosen; the values do not depend on the unit system
/// source : Reneker, Yarin, Fong, Koombhongse, J. Appl. Phys. 87 (2000) 4531;
///          Lauricella, Pontrelli, Coluzza, Pisignano, Succi, Comput. Phys. Commun. 197 (2015)
///          227 (JETSPIN)
/// checked: DimensionlessGroups tests, against what the reference code prints for the PVP jet
struct DimensionlessGroups {
  double length = 0;                     ///< L0 [m]
  double time = 0;                       ///< tau [s]
  double coulomb = 0;                    ///< Q
  double viscoelastic = 0;               ///< Fve
  double viscoelastic_jetspin = 0;       ///< Fve'
  double nozzle_motion = 0;              ///< Ks
  std::optional<double> field;           ///< Phi, absent like its term
  std::optional<double> surface_tension; ///< A
  std::optional<double> collector;       ///< H
  std::optional<double> gravity;         ///< Fg
};

/// Absent without a nozzle, charge or viscoelastic fluid: then there is no L0 or no tau.
std::optional<DimensionlessGroups> dimensionless_groups(const SceneConfig& config);

/// The strength of the external field along +x, however it is given; 0 without [field] [V/m].
double field_strength(const SceneConfig& config);

/// Whether links have a stress. That of a Maxwell fluid without elasticity, or without viscosity to hold
/// it, is zero at all times.
bool carries_stress(const SceneConfig& config);

} // namespace ehdjet
