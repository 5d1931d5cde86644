#pragma once

#include "ehdjet/core/schedule.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <functional>
#include <optional>

namespace ehdjet {

/// Cuts the jet anew, at exact multiples of t_ref from the first one on, where its links have
/// become too long, and joins links that are needlessly short if the rule says so (model 7).
class Refinement final : public Event {
public:
  /// What is needed to record the change of energy.
  struct Recording {
    double elastic_modulus = 0; ///< G [Pa]; 0: there is no stress
    /// [J]; may be empty: the Coulomb energy costs as much as a direct sum
    std::function<double(const JetState&)> coulomb_energy;
  };

  /// `interval`: t_ref [s]. Without `recording` nothing but the mesh is computed.
  Refinement(const RefinementRule& rule, double interval,
             std::optional<Recording> recording = {});
  [[nodiscard]] std::string_view name() const override { return "refinement"; }
  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  [[nodiscard]] bool due(const JetState& jet) const override {
    return jet.time >= schedule_.next();
  }
  [[nodiscard]] std::optional<double> locate(const DenseStep&) override { return {}; }
  [[nodiscard]] std::optional<double> predict(const DenseStep&) const override {
    return {};
  }
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }

private:
  RefinementRule rule_;
  Schedule schedule_;
  std::optional<Recording> recording_;
};

} // namespace ehdjet
