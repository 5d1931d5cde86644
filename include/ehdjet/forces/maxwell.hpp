#pragma once

#include "ehdjet/forces/axial_stress.hpp"
#include "ehdjet/forces/fluid.hpp"

namespace ehdjet {

/// The law of a Maxwell fluid, elastic at short and viscous at long times:
///
///     d sigma/dt = G e - (G/mu) sigma                                   (model 2)
///
/// source : Reneker, Yarin, Fong & Koombhongse, J. Appl. Phys. 87 (2000) 4531
template <class Fluid = UniformFluid>
struct MaxwellLaw {
  Fluid fluid;

  /// Whether the rate is the sum of one of e and one of sigma, the former in proportion to e.
  static constexpr bool is_linear = true;

  [[nodiscard]] double modulus(std::size_t k) const { return fluid.modulus(k); }
  [[nodiscard]] double relaxation_rate(std::size_t k) const {
    return fluid.relaxation_rate(k);
  }
  [[nodiscard]] double typical_modulus() const { return fluid.typical_modulus(); }
  /// L [Pa/s] of link k for e = stretching/area; the area is 1 or l^2.
  [[nodiscard]] double rate(std::size_t k, double stretching, double area,
                            double sigma) const {
    return modulus(k) * stretching / area - relaxation_rate(k) * sigma;
  }
  /// dL/de [Pa].
  [[nodiscard]] double slope(std::size_t k, double /*strain_rate*/) const {
    return modulus(k);
  }
  /// Per volume: sigma e less the growth of sigma^2/(2 G) by L [W/m^3].
  [[nodiscard]] double dissipation(std::size_t k, double volume, double /*strain_rate*/,
                                   double sigma) const {
    return volume * sigma * sigma * relaxation_rate(k) / modulus(k);
  }
  static constexpr const char* dissipation_meaning =
      "lost so far to viscosity, sum V sigma^2/mu over time";
};

/// Maxwell fluid: one axial stress per link. `AxialStress` has the equations.
class Maxwell final : public AxialStress<MaxwellLaw<>> {
public:
  Maxwell(double elastic_modulus, double viscosity); ///< G [Pa], mu [Pa s], both > 0
};

} // namespace ehdjet
