#pragma once

#include "ehdjet/dynamics/acting_chain.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/observers/observer.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// What pulls the two ends of a link together, all terms that act along links taken together:
///
///     T_eff = pi a^2 sigma + pi a alpha - P                                 (model 3.1)
///
/// Where it is negative, bending is unstable down to the length of the links: what the jet does
/// there depends on the mesh.
class EffectiveTension final : public Accounts {
public:
  /// Of the terms of `dynamics`, which outlives this.
  explicit EffectiveTension(const JetDynamics& dynamics);

  struct Summary {
    double unstable_links = 0;    ///< share of the links with T_eff < 0 [-]
    double smallest = 0;          ///< T_eff [N]
    double shortest_in_radii = 0; ///< l/a
  };
  [[nodiscard]] Summary of(const JetState& jet);

  [[nodiscard]] std::span<const Column> columns() const override;
  void measure(const JetSnapshot& snapshot, std::span<double> row) override;

private:
  const JetDynamics& dynamics_;
  ActingChain chain_;
  std::vector<double> tension_; // of every link [N]
};

} // namespace ehdjet
