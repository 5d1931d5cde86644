#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet {

/// The momentum of the fluid that a pump brings into link 1, relative to that of bead 1:
///
///     F_1 = rho Q (v_N - v_1),   v_N = w0 + v_s x                        (model 4.3)
///
/// w0 is the velocity of the nozzle on its circle.
/// laws   : with the growth of m_1 the momentum of the jet grows by rho Q v_N per second, its kinetic
///          energy by rho Q v_N^2/2 less rho Q |v_1 - v_N|^2/2, which mixing dissipates
class FeedMomentum final : public ForceTerm {
public:
  [[nodiscard]] std::string_view name() const override { return "inflow"; }
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& derivatives) override;
  [[nodiscard]] TermAccount account() const override;
  void add_power(const Stage& stage, Exchange& exchange) override;
};

} // namespace ehdjet
