#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <vector>

namespace ehdjet {

/// A viscous stress along the links: the solvent of a polymer solution, eta = 3 mu_s (model 2.3), or the
/// dashpot of a Kelvin-Voigt body, eta = mu (model 2.4).
///
///     F_k = T_(k+1) t_(k+1) - T_k t_k,   T_k = (V_k/l_k) eta e_k,   e_k = (v_k - v_(k-1)).t_k/l_k
///
/// units  : eta [Pa s]
/// laws   : internal forces sum to zero; vanishes under rigid motion; loses sum V eta e^2
/// A landed bead is at rest (model 5).
class ViscousStress final : public ForceTerm {
public:
  explicit ViscousStress(double viscosity); ///< eta > 0
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "viscosity"; }
  [[nodiscard]] TermAccount account() const override;
  void add_power(const Stage& stage, Exchange& exchange) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  double viscosity_;
  std::vector<double> tension_per_length_, strain_rate_; // [N/m], [1/s]
};

} // namespace ehdjet
