#pragma once

#include "ehdjet/forces/axial_stress.hpp"
#include "ehdjet/forces/fluid.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {

/// A stress that depends on the strain rate alone, odd in it:
///
///     sigma(e) = sgn(e) (tau_Y (1 - exp(-m |e|)) + K |e|^n)             (model 2.5)
///
/// Bingham: n = 1. Power law: tau_Y = 0.
/// source : Herschel & Bulkley, Kolloid-Z. 39 (1926) 291; regularized as in Papanastasiou, J. Rheol. 31
///          (1987) 385
struct HerschelBulkleyCurve {
  double consistency = 0;    ///< K >= 0 [Pa s^n]
  double flow_index = 1;     ///< n > 0
  double yield_stress = 0;   ///< tau_Y >= 0 [Pa]
  double regularization = 0; ///< m >= 0 [s]

  [[nodiscard]] double stress(double strain_rate) const {
    const double e = std::abs(strain_rate);
    return std::copysign(yield_stress * -std::expm1(-regularization * e)
                             + consistency * std::pow(e, flow_index),
                         strain_rate);
  }
  /// d sigma/de [Pa s]. For n < 1 it grows without bound as e goes to 0: below `least` [1/s] it is
  /// that of `least`.
  [[nodiscard]] double slope(double strain_rate, double least) const {
    const double e = std::abs(strain_rate);
    return yield_stress * regularization * std::exp(-regularization * e)
           + consistency * flow_index * std::pow(std::max(e, least), flow_index - 1);
  }
};

/// A Herschel-Bulkley fluid that takes the time mu/G to follow its curve, so that it is a Maxwell
/// fluid where the curve is sigma(e) = mu e:
///
///     d sigma/dt = (G/mu) (sigma(e) - sigma)                            (model 2.5)
///
/// In the energy balance G is the modulus of what is stored.
template <class Fluid = UniformFluid>
struct HerschelBulkleyLaw {
  Fluid fluid;
  HerschelBulkleyCurve curve;

  static constexpr bool is_linear = false;

  [[nodiscard]] double modulus(std::size_t k) const { return fluid.modulus(k); }
  [[nodiscard]] double relaxation_rate(std::size_t k) const {
    return fluid.relaxation_rate(k);
  }
  [[nodiscard]] double typical_modulus() const { return fluid.typical_modulus(); }
  [[nodiscard]] double rate(std::size_t k, double stretching, double area,
                            double sigma) const {
    return relaxation_rate(k) * (curve.stress(stretching / area) - sigma);
  }
  [[nodiscard]] double slope(std::size_t k, double strain_rate) const {
    constexpr double slow = 1e-3; // strain per relaxation time
    return relaxation_rate(k) * curve.slope(strain_rate, slow * relaxation_rate(k));
  }
  [[nodiscard]] double dissipation(std::size_t k, double volume, double strain_rate,
                                   double sigma) const {
    return volume * sigma * (strain_rate - rate(k, strain_rate, 1, sigma) / modulus(k));
  }
  static constexpr const char* dissipation_meaning =
      "lost so far to viscosity, sum V sigma (e - (sigma(e) - sigma)/mu) over time";
};

/// `AxialStress` has the equations.
class HerschelBulkley final : public AxialStress<HerschelBulkleyLaw<>> {
public:
  /// G [Pa], mu [Pa s], both > 0
  HerschelBulkley(double elastic_modulus, double viscosity,
                  const HerschelBulkleyCurve& curve);
};

} // namespace ehdjet
