#pragma once

#include "ehdjet/forces/air_flow.hpp"
#include "ehdjet/forces/force_term.hpp"

#include <cstddef>
#include <string_view>

namespace ehdjet {

/// A polymer in a solvent whose volumes add up (model 2.2).
struct Solution {
  double polymer_density = 0, solvent_density = 0; ///< rho_p, rho_s [kg/m^3]
  double polymer_fraction = 0; ///< c_0, mass of the polymer over that of the solution [-]

  /// Of the solution: 1/(c_0/rho_p + (1 - c_0)/rho_s) [kg/m^3].
  [[nodiscard]] double density() const;
  /// Volume of the polymer over that of the solution [-].
  [[nodiscard]] double polymer_volume() const;
  /// c when e of the volume has evaporated: rho_p V_p/(rho_p V_p + rho_s V_s) [-].
  [[nodiscard]] double fraction_after(double lost) const;
  /// e at which the polymer makes up that fraction of the mass.
  [[nodiscard]] double lost_at(double fraction) const;
};

/// How the solvent leaves the surface of a link (model 2.2).
struct Vaporisation {
  double diffusivity = 0;          ///< D of the vapour in air [m^2/s]
  double saturation = 0;           ///< C_sat, vapour per volume of saturated air [kg/m^3]
  double humidity = 0;             ///< phi, vapour in the air over saturation [-]
  double solid_fraction = 0.9;     ///< c at which evaporation ends [-]
  double still_air_sherwood = 0.3; ///< Sh of a link that moves with the air [-]
  /// Over so much of what can evaporate in all the rate falls to zero at the end [-].
  double ending = 0.01;
};

/// Evaporation: column `evaporated`, e = (V_0 - V)/V_0 of each link, with V_0 its volume as it left the
/// nozzle.
///
///     V_0 de/dt = pi l D Sh (C_sat/rho_s) (1 - phi) (1 - exp(-(e_solid - e)/delta))
///     Sh = 2 a h_m/D = 0.3 + 0.495 Re^(1/3) Sc^(1/2),   Re = 2 a |w|/nu,  Sc = nu/D       (model 2.2)
///
/// with w the velocity of the middle of the link against the air. The last factor is 1 but at the very
/// end, where it makes the rate smooth.
/// laws   : the sum of V_0 e is kept when links are redistributed, and e stays below e_solid
/// source : Yarin, Koombhongse & Reneker, J. Appl. Phys. 89 (2001) 3018
class Evaporation final : public ForceTerm {
public:
  static constexpr std::string_view column = evaporated;

  Evaporation(AirFlow air, const Solution& solution, const Vaporisation& vaporisation);
  [[nodiscard]] std::string_view name() const override { return "evaporation"; }
  void add_force(const Stage& /*stage*/, Vec3View /*force*/) override {} // it has none
  /// What vapour takes along is added by Balance, as it concerns the energies of all terms.
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] std::vector<BeadColumn> columns() const override;
  void bind(const BeadTable& table) override;
  void set_column_rates(const Stage& stage, JetColumns<double> rates) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& derivatives) override;

private:
  struct Rate {
    double value, decay; // [1/s]
  };
  [[nodiscard]] Rate rate(const Stage& stage, std::size_t k, const Vec3& v,
                          const Vec3& v_upstream) const;
  [[nodiscard]] double mixing(const Stage& stage) const;

  AirFlow air_;
  Solution solution_;
  double still_, driven_; // Sh = still + driven Re^(1/3)
  double conductance_;    // pi D C_sat (1 - phi)/rho_s [m^2/s]
  double end_, ending_;   // e at the end, delta
  std::size_t lost_ = 0;  // its column
};

} // namespace ehdjet
