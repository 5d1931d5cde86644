#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <vector>

namespace ehdjet {

/// The spring of a Kelvin-Voigt body: a stress that follows from the length of a link alone.
///
///     sigma_k = G ln(l_k/l_ref,k),   T_k = (V_k/l_k) sigma_k                            (model 2.4)
///
/// l_ref is the length of the link without stress. It is an amount like the volume: parts of a link
/// share it out. A new link has that of its fluid at the section of the nozzle, so that
/// sigma = G ln(A0/A) there; in a link that is fed l_ref = V_1/A0 grows with the volume (model 2.4).
///
/// units  : G [Pa], l_ref [m]
/// laws   : internal forces sum to zero; conservative, U = sum V sigma^2/(2 G)
class HenckyElasticity final : public ForceTerm {
public:
  struct Options {
    double elastic_modulus = 0; ///< G > 0 [Pa]
    double length_at_birth = 0; ///< l_ref of a link at its birth [m]
    double nozzle_stretch = 1;  ///< of the fluid that leaves the nozzle of a pump
  };
  explicit HenckyElasticity(const Options& options);
  void add_force(const Stage& stage, Vec3View force) override;
  /// reference_length (carried, shared out) [m]
  [[nodiscard]] std::vector<BeadColumn> columns() const override;
  void bind(const BeadTable& table) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "viscoelasticity"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  [[nodiscard]] double reference(const Stage& stage, std::size_t k) const; // [m]
  [[nodiscard]] double stress(const Stage& stage, std::size_t k) const;

  Options options_;
  std::size_t reference_ = 0;              // its column
  std::vector<double> tension_per_length_; // [N/m]
};

} // namespace ehdjet
