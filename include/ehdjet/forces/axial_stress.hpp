#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <vector>

namespace ehdjet {

/// A fluid with one axial stress per link, integrated in time.
///
///     d sigma_k/dt = L(e_k, sigma_k),   e_k = (v_k - v_(k-1)).t_k/l_k                 (model 2)
///     F_k = - pi a_k^2 sigma_k t_k + pi a_(k+1)^2 sigma_(k+1) t_(k+1),  pi a_k^2 = V_k/l_k
///
/// units  : sigma [Pa], e [1/s]
/// laws   : internal forces sum to zero; the rate vanishes under rigid motion
/// A landed bead keeps its stress, and counts as at rest for the link below it (model 5). The stress
/// of a link that is fed follows model 4.3.
///
/// `Law` says what L is; its members are those of `MaxwellLaw` (forces/maxwell.hpp).
template <class Law>
class AxialStress : public ForceTerm {
public:
  explicit AxialStress(const Law& law)
      : law_(law) {}
  void add_force(const Stage& stage, Vec3View force) override;
  /// stress (integrated, of links) [Pa]
  [[nodiscard]] std::vector<BeadColumn> columns() const override;
  void bind(const BeadTable& table) override;
  void set_column_rates(const Stage& stage, JetColumns<double> rates) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "viscoelasticity"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< sum V sigma^2/(2 G)
  void add_power(const Stage& stage, Exchange& exchange) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  [[nodiscard]] double entry_stress(const Stage& stage) const;
  [[nodiscard]] double fed_rate(const Stage& stage) const;
  Law law_;
  std::size_t stress_ = 0;                 // its column
  std::vector<double> tension_per_length_; // V sigma / l^2 [N/m]
};

} // namespace ehdjet
