#pragma once

#include "ehdjet/forces/fluid.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace ehdjet {

/// The axial and the radial component of a tensor in a thread.
struct AxialPair {
  double zz = 0, rr = 0;
};

/// Derivatives of a law for the state s of a link, as `LinkDerivatives` has them.
struct PairSlopes {
  AxialPair strain;     ///< d s'/de
  AxialPair relaxation; ///< - d s'_zz/d s_zz, - d s'_rr/d s_rr [1/s]
  AxialPair coupling;   ///< - d s'_zz/d s_rr, - d s'_rr/d s_zz [1/s]
  AxialPair pull;       ///< dN1/ds [Pa]
};

/// Laws of the stress tensor tau of a thread that is strained at the rate e, with a modulus G and a
/// relaxation time lambda (model 2.3). A law has a state s, two numbers per link:
///
///     rate                of s [1/s]
///     stress_difference   N1 = tau_zz - tau_rr, which pulls [Pa]
///     of_stretch          s of a fluid at rest that is stretched to so many times its length at once
///     slopes              all derivatives
///     energy              of the springs that the law stands for, W = tr tau/2 [J/m^3]
///     energy_slope        dW/ds
///     dissipation         e N1 - dW/dt [W/m^3]
///
/// `Fluid` says what G and 1/lambda are; its members are those of UniformFluid.

/// Upper-convected Maxwell fluid, s = tau:
///
///     d tau_zz/dt = 2 e tau_zz + 2 G e - tau_zz/lambda
///     d tau_rr/dt = - e tau_rr - G e - tau_rr/lambda                    (model 2.3)
///
/// source : Bird, Armstrong & Hassager, Dynamics of Polymeric Liquids 1, 2nd ed. (1987), ch. 7
template <class Fluid = UniformFluid>
struct UpperConvected {
  Fluid fluid;
  static constexpr bool coupled = false, is_stress = true;

  [[nodiscard]] AxialPair rate(std::size_t k, double e, AxialPair s) const {
    const double g = fluid.modulus(k), r = fluid.relaxation_rate(k);
    return {.zz = 2 * e * (g + s.zz) - r * s.zz, .rr = -e * (g + s.rr) - r * s.rr};
  }
  [[nodiscard]] double stress_difference(std::size_t /*k*/, AxialPair s) const {
    return s.zz - s.rr;
  }
  [[nodiscard]] AxialPair of_stretch(std::size_t k, double stretch) const {
    const double g = fluid.modulus(k);
    return {.zz = g * (stretch * stretch - 1), .rr = g * (1 / stretch - 1)};
  }
  /// d of_stretch/d ln stretch.
  [[nodiscard]] AxialPair stretch_slope(std::size_t k, double stretch) const {
    const double g = fluid.modulus(k);
    return {.zz = 2 * g * stretch * stretch, .rr = -g / stretch};
  }
  [[nodiscard]] PairSlopes slopes(std::size_t k, double e, AxialPair s) const {
    const double g = fluid.modulus(k), r = fluid.relaxation_rate(k);
    return {.strain = {.zz = 2 * (g + s.zz), .rr = -(g + s.rr)},
            .relaxation = {.zz = r - 2 * e, .rr = r + e},
            .coupling = {},
            .pull = {.zz = 1, .rr = -1}};
  }
  [[nodiscard]] double energy(std::size_t /*k*/, AxialPair s) const {
    return (s.zz + 2 * s.rr) / 2;
  }
  [[nodiscard]] AxialPair energy_slope(std::size_t /*k*/, AxialPair /*s*/) const {
    return {.zz = 0.5, .rr = 1};
  }
  [[nodiscard]] double dissipation(std::size_t k, AxialPair s) const {
    return fluid.relaxation_rate(k) * (s.zz + 2 * s.rr) / 2;
  }
};

/// Giesekus fluid: relaxation is faster where stress is high, by - (alpha_G/(G lambda)) tau^2 in the
/// rates of an upper-convected Maxwell fluid.                          (model 2.3)
///
/// source : Giesekus, J. Non-Newtonian Fluid Mech. 11 (1982) 69
template <class Fluid = UniformFluid>
struct Giesekus {
  Fluid fluid;
  double mobility = 0; ///< alpha_G, 0 ... 1
  static constexpr bool coupled = false, is_stress = true;

  [[nodiscard]] AxialPair rate(std::size_t k, double e, AxialPair s) const {
    const AxialPair linear = base().rate(k, e, s);
    const double c = quadratic(k);
    return {.zz = linear.zz - c * s.zz * s.zz, .rr = linear.rr - c * s.rr * s.rr};
  }
  [[nodiscard]] double stress_difference(std::size_t k, AxialPair s) const {
    return base().stress_difference(k, s);
  }
  [[nodiscard]] AxialPair of_stretch(std::size_t k, double stretch) const {
    return base().of_stretch(k, stretch);
  }
  [[nodiscard]] AxialPair stretch_slope(std::size_t k, double stretch) const {
    return base().stretch_slope(k, stretch);
  }
  [[nodiscard]] PairSlopes slopes(std::size_t k, double e, AxialPair s) const {
    PairSlopes slopes = base().slopes(k, e, s);
    slopes.relaxation.zz += 2 * quadratic(k) * s.zz;
    slopes.relaxation.rr += 2 * quadratic(k) * s.rr;
    return slopes;
  }
  [[nodiscard]] double energy(std::size_t k, AxialPair s) const {
    return base().energy(k, s);
  }
  [[nodiscard]] AxialPair energy_slope(std::size_t k, AxialPair s) const {
    return base().energy_slope(k, s);
  }
  [[nodiscard]] double dissipation(std::size_t k, AxialPair s) const {
    return base().dissipation(k, s) + quadratic(k) * (s.zz * s.zz + 2 * s.rr * s.rr) / 2;
  }

private:
  [[nodiscard]] UpperConvected<Fluid> base() const { return {fluid}; }
  [[nodiscard]] double quadratic(std::size_t k) const {
    return mobility * fluid.relaxation_rate(k) / fluid.modulus(k);
  }
};

/// FENE-P fluid, springs of finite length, s = A, the conformation:
///
///     dA_zz/dt = 2 e A_zz - (f A_zz - 1)/lambda,   dA_rr/dt = - e A_rr - (f A_rr - 1)/lambda
///     f = (L2 - 3)/(L2 - A_zz - 2 A_rr),   tau = G (f A - 1)            (model 2.3)
///
/// Where A has left the range of the springs, f is no number, and a step that ends there is repeated.
/// The energy is - G (L2 - 3)/2 ln((L2 - tr A)/(L2 - 3)).
/// source : Bird, Dotson & Johnson, J. Non-Newtonian Fluid Mech. 7 (1980) 213
template <class Fluid = UniformFluid>
struct FeneP {
  Fluid fluid;
  double extensibility = 0; ///< L2 > 3
  static constexpr bool coupled = true, is_stress = false;

  [[nodiscard]] AxialPair rate(std::size_t k, double e, AxialPair s) const {
    const double f = spring(s), r = fluid.relaxation_rate(k);
    return {.zz = 2 * e * s.zz - r * (f * s.zz - 1), .rr = -e * s.rr - r * (f * s.rr - 1)};
  }
  [[nodiscard]] double stress_difference(std::size_t k, AxialPair s) const {
    return fluid.modulus(k) * spring(s) * (s.zz - s.rr);
  }
  [[nodiscard]] AxialPair of_stretch(std::size_t /*k*/, double stretch) const {
    return {.zz = stretch * stretch, .rr = 1 / stretch};
  }
  [[nodiscard]] AxialPair stretch_slope(std::size_t /*k*/, double stretch) const {
    return {.zz = 2 * stretch * stretch, .rr = -1 / stretch};
  }
  [[nodiscard]] PairSlopes slopes(std::size_t k, double e, AxialPair s) const {
    const double g = fluid.modulus(k), r = fluid.relaxation_rate(k);
    const double f = spring(s), df = f / room(s),
                 n = s.zz - s.rr; // df/dA_zz = df/dA_rr / 2
    return {.strain = {.zz = 2 * s.zz, .rr = -s.rr},
            .relaxation = {.zz = r * (f + s.zz * df) - 2 * e,
                           .rr = r * (f + 2 * s.rr * df) + e},
            .coupling = {.zz = 2 * r * s.zz * df, .rr = r * s.rr * df},
            .pull = {.zz = g * (f + n * df), .rr = g * (2 * n * df - f)}};
  }
  [[nodiscard]] double energy(std::size_t k, AxialPair s) const {
    return -fluid.modulus(k) * (extensibility - 3) / 2
           * std::log(room(s) / (extensibility - 3));
  }
  [[nodiscard]] AxialPair energy_slope(std::size_t k, AxialPair s) const {
    const double slope = fluid.modulus(k) * spring(s) / 2; // dW/d tr A
    return {.zz = slope, .rr = 2 * slope};
  }
  [[nodiscard]] double dissipation(std::size_t k, AxialPair s) const {
    const double f = spring(s);
    return fluid.modulus(k) * fluid.relaxation_rate(k) * f * (f * (s.zz + 2 * s.rr) - 3)
           / 2;
  }

private:
  [[nodiscard]] double room(AxialPair s) const { return extensibility - s.zz - 2 * s.rr; }
  [[nodiscard]] double spring(AxialPair s) const {
    const double r = room(s);
    return r > 0 ? (extensibility - 3) / r : std::numeric_limits<double>::quiet_NaN();
  }
};

} // namespace ehdjet
