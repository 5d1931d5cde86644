#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"
#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/link_derivatives.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ehdjet {

/// One additive contribution to the equations of motion (model 2). A term that a scene does not
/// name is never constructed; there is no null term and no "enabled" flag. One virtual call per
/// term and evaluation: the loop over beads is inside the term.
class ForceTerm {
public:
  virtual ~ForceTerm() = default;
  /// force (beads) += ... [N]. Entries of beads that do not move (nozzle, embryo, landed) may
  /// hold anything: their rates are set to zero afterwards.
  virtual void add_force(const Stage& stage, Vec3View force) = 0;
  /// links += what the force, and a stress rate, answer to a change of a link, for implicit steps.
  /// Only terms that may be stiff, which are all local, have something to add.
  virtual void add_derivatives(const Stage& /*stage*/, LinkDerivatives& /*links*/) {}
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Pairs of beads at zero distance that were skipped so far, all evaluations together.
  [[nodiscard]] virtual std::uint64_t coincident_pairs() const { return 0; }
  /// How the term is computed, if there is something to tell.
  [[nodiscard]] virtual std::string method() const { return {}; }
  /// Comparisons with an exact method, if there are such.
  [[nodiscard]] virtual std::optional<CoulombChecks> checks() const { return {}; }
  /// What the term keeps from one evaluation to the next.
  virtual void archive(const Archive& /*a*/) {}
};

/// A force term with an internal variable per link, integrated with the jet.
class Rheology : public ForceTerm {
public:
  /// rate (beads) = d sigma/dt [Pa/s]
  virtual void stress_rate(const Stage& stage, std::span<double> rate) = 0;
};

} // namespace ehdjet
