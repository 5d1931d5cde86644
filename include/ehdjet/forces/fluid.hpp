#pragma once

#include "ehdjet/forces/evaporation.hpp"
#include "ehdjet/jet/bead_table.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace ehdjet {

/// Modulus and relaxation rate of the fluid in link k: everywhere the same.
///
/// The laws of viscoelasticity take these two from a class with the members of this one, so that a
/// fluid whose properties differ from link to link is another such class and no branch.
struct UniformFluid {
  double elastic_modulus = 0; ///< G [Pa]
  double relaxation = 0;      ///< 1/tau, G/mu [1/s]

  [[nodiscard]] double modulus(std::size_t /*link*/) const { return elastic_modulus; }
  [[nodiscard]] double relaxation_rate(std::size_t /*link*/) const { return relaxation; }
  /// The scale of stresses [Pa].
  [[nodiscard]] double typical_modulus() const { return elastic_modulus; }
  /// Called once, and with a stage before its links are asked for.
  static void bind(const BeadTable& /*table*/) {}
  static void look_at(const Stage& /*stage*/) {}
};

/// How the viscosity and the relaxation time of a solution grow as it dries (model 2.2):
///
///     mu/mu_0 = 10^(B (c^m - c_0^m)),   tau/tau_0 = c/c_0,   G = mu/tau
///
/// source : Yarin, Koombhongse & Reneker, J. Appl. Phys. 89 (2001) 3018
struct Thickening {
  Solution solution;
  double exponent = 7, power = 0.1; ///< B, m

  [[nodiscard]] double viscosity_ratio(double fraction) const;  ///< mu/mu_0 at c
  [[nodiscard]] double relaxation_ratio(double fraction) const; ///< tau/tau_0 at c
};

/// Modulus and relaxation rate of a fluid that dries: as `UniformFluid` where nothing has evaporated.
class DryingFluid {
public:
  /// G [Pa] and 1/tau [1/s] as the fluid leaves the nozzle.
  DryingFluid(double elastic_modulus, double relaxation, const Thickening& thickening);

  [[nodiscard]] double modulus(std::size_t link) const {
    return elastic_modulus_ * (link < ratios_->modulus.size() ? ratios_->modulus[link] : 1);
  }
  [[nodiscard]] double relaxation_rate(std::size_t link) const {
    return relaxation_ * (link < ratios_->rate.size() ? ratios_->rate[link] : 1);
  }
  [[nodiscard]] double typical_modulus() const { return elastic_modulus_; }
  void look_at(const Stage& stage) const;
  void bind(const BeadTable& table) const;

private:
  /// To the values at the nozzle, link by link, at the stage last looked at. Copies of a law share them.
  struct Ratios {
    std::size_t lost = 0; // column of what has evaporated
    std::vector<double> modulus, rate;
  };
  double elastic_modulus_, relaxation_;
  Thickening thickening_;
  std::shared_ptr<Ratios> ratios_ = std::make_shared<Ratios>();
};

} // namespace ehdjet
