#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet {

/// Uniform electric field between nozzle and collector.
///
///     F_k = q_k (Phi0/h) x                                              (model 2)
class ExternalField final : public ForceTerm {
public:
  explicit ExternalField(double strength) // [V/m]
      : strength_(strength) {}
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "external field"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< - sum q E x
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;

private:
  double strength_;
};

} // namespace ehdjet
