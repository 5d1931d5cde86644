#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <optional>

namespace ehdjet {

/// Uniform electric field between nozzle and collector, which may change in time.
///
///     F_k = q_k E(t) x,   E = Phi0/h                                    (model 2)
///     E(t) = Phi0/h or 0                     switched: Stage::field_is_off
///     E(t) = (Phi0/h) (1 - exp(-t/tau))      charged through a resistor      (model 2.6)
class ExternalField final : public ForceTerm {
public:
  struct Options {
    double strength = 0;                      ///< Phi0/h [V/m]
    bool is_switched = false;                 ///< by an event
    std::optional<double> charging_time = {}; ///< tau [s]
  };
  explicit ExternalField(const Options& options)
      : options_(options) {}
  explicit ExternalField(double strength) // [V/m]
      : options_{.strength = strength} {}
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "external field"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< - sum q E x
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;

  /// dU/dt at rest while the field rises.
  void add_power(const Stage& stage, Exchange& exchange) override;

private:
  [[nodiscard]] double strength(const Stage& stage) const;

  Options options_;
};

} // namespace ehdjet
