#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/forces/tensor_laws.hpp"

#include <span>
#include <string>
#include <vector>

namespace ehdjet {

/// A fluid whose stress is a tensor with an axial and a radial component in each link, one mode of it:
///
///     F_k = T_(k+1) t_(k+1) - T_k t_k,   T_k = (V_k/l_k) (tau_zz - tau_rr)             (model 2.3)
///
/// The laws are in forces/tensor_laws.hpp. Modes add up: each is a term of its own.
///
/// units  : tau [Pa], A [1]
/// laws   : internal forces sum to zero; the rates vanish under rigid motion of a fluid at rest
/// A landed bead keeps the state of its link, and counts as at rest for the link below it (model 5). New
/// fluid in a link that is fed is stretched at once and mixed in by volume (model 2.3, 4.3).
template <class Law>
class TensorStress final : public ForceTerm {
public:
  struct Options {
    std::size_t mode = 0;      ///< 0: the only one; else its number, which the columns bear
    double nozzle_stretch = 1; ///< of the fluid that leaves the nozzle of a pump
  };
  explicit TensorStress(const Law& law, const Options& options = {});
  void add_force(const Stage& stage, Vec3View force) override;
  /// tau_zz, tau_rr [Pa], or conformation_zz, conformation_rr [1] (integrated, of links)
  [[nodiscard]] std::vector<BeadColumn> columns() const override;
  void bind(const BeadTable& table) override;
  void set_column_rates(const Stage& stage, JetColumns<double> rates) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< sum V W
  void add_power(const Stage& stage, Exchange& exchange) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  [[nodiscard]] std::string column_name(const char* component) const;
  [[nodiscard]] AxialPair state(const Stage& stage, std::size_t k) const {
    return {.zz = stage.columns.column(zz_)[k], .rr = stage.columns.column(rr_)[k]};
  }
  [[nodiscard]] double entry_stretch(const Stage& stage) const;

  Law law_;
  Options options_;
  std::string name_;
  std::size_t zz_ = 0, rr_ = 0;                          // its columns
  std::vector<double> tension_per_length_, strain_rate_; // [N/m], [1/s]
};

/// The stretch of fluids at rest, `laws`, that gives them together the stress difference N1 [Pa].
template <class Law>
[[nodiscard]] double stretch_of_stress(std::span<const Law> laws, double stress_difference);

} // namespace ehdjet
