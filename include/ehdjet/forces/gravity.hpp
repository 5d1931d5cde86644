#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet {

/// Weight, along +x (the nozzle is above the collector).
///
///     F_k = m_k g x                                                     (model 2)
class Gravity final : public ForceTerm {
public:
  explicit Gravity(double acceleration) // [m/s^2]
      : acceleration_(acceleration) {}
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "gravity"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< - sum m g x
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;

private:
  double acceleration_;
};

} // namespace ehdjet
