#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"
#include "ehdjet/forces/link_derivatives.hpp"
#include "ehdjet/jet/exchange.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// What a term has to tell about its work so far.
struct TermReport {
  std::string method;                 ///< how the force is computed, for people to read
  std::uint64_t coincident_pairs = 0; ///< at zero distance, skipped: most per evaluation
  /// Comparisons with an exact method; none if there are no comparisons.
  struct Checks {
    double last_error = 0;        ///< relative
    std::uint64_t violations = 0; ///< comparisons that found more than the tolerance
  };
  std::optional<Checks> checks = {};
};

/// How a term enters a budget of energy and momentum (model 8).
struct TermAccount {
  std::string energy = {},
              energy_meaning = {}; ///< its stored energy; no name: it stores none
  /// Where the rest goes. Without stored energy that is the work of the force. Momentum columns
  /// mean that the momentum comes from outside; without them the forces between the beads sum to
  /// zero.
  Channel channel = {};
  /// The energy depends on places and charges only, not on masses and volumes.
  bool of_charges_only = false;
  /// `add_power` tells all that the force exchanges with the outside, as if the term stored an energy.
  bool tells_all_power = false;
};

/// One additive contribution to the equations of motion (model 2). A term that a scene does not
/// name is never constructed; there is no null term and no "enabled" flag. One virtual call per
/// term and evaluation: the loop over beads is inside the term.
///
/// A term also accounts for itself: what it stores as energy and what it exchanges with the outside.
/// As long as it overrides nothing of that, the work and the impulse of its force have columns under
/// its own name, and a budget closes.
class ForceTerm {
public:
  virtual ~ForceTerm() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// force (beads) += ... [N], on the targets of the stage. The force on a target that does not move
  /// freely (nozzle, embryo, landed) is what its support has to bear; rates are set to zero
  /// afterwards. Entries of beads that are no targets may get anything.
  virtual void add_force(const Stage& stage, Vec3View force) = 0;

  /// Columns that the term adds to those of the jet.
  [[nodiscard]] virtual std::vector<BeadColumn> columns() const { return {}; }
  /// Tells the term, before all else, where in the table of the jet it finds columns.
  virtual void bind(const BeadTable& /*table*/) {}
  /// Writes the rates of the integrated columns that the term has added, at the targets of the
  /// stage. Rates of a bead's columns while it does not move freely, of a link's while its bead
  /// rests, and entry 0 of a column of links are set to zero afterwards.
  virtual void set_column_rates(const Stage& /*stage*/, JetColumns<double> /*rates*/) {}

  /// derivatives += what the force, and a column of links, answer to a change of a link or of a bead's
  /// velocity, for implicit steps. Only terms that may be stiff, which are all local, have
  /// something to add.
  virtual void add_derivatives(const Stage& /*stage*/, LinkDerivatives& /*derivatives*/) {}

  [[nodiscard]] virtual TermAccount account() const;
  /// Stored energy [J]; -dU/dr is the force.
  [[nodiscard]] virtual double energy(const Stage& /*stage*/) { return 0; }
  /// Stored energy after an event less the one before it [J].
  [[nodiscard]] virtual double energy_change(const Stage& before, const Stage& after) {
    return energy(after) - energy(before);
  }
  /// dU/dt at rest, while what bead 1 carries grows at that rate [W].
  [[nodiscard]] virtual double feeding_power(const Stage& /*stage*/,
                                             const LinkContent& /*rate*/) {
    return 0;
  }
  /// force (beads) += ... on those beads, which do not move freely. Entries of others may get
  /// anything. For terms that need less than `add_force` for that.
  virtual void add_force_on(std::span<const std::size_t> /*beads*/, const Stage& stage,
                            Vec3View force) {
    add_force(stage, force);
  }
  /// What the term brings in per second besides the work of its force on beads that move: what it
  /// dissipates, what it costs to feed it.
  virtual void add_power(const Stage& /*stage*/, Exchange& /*exchange*/) {}

  /// tension (beads) += T_k, what a term that acts along links pulls its two ends together with [N].
  virtual void add_tension(const Stage& /*stage*/, std::span<double> /*tension*/) {}

  /// None if there is nothing to tell.
  [[nodiscard]] virtual std::optional<TermReport> report() const { return {}; }
  /// What the term keeps from one evaluation to the next.
  virtual void archive(const Archive& /*a*/) {}
};

} // namespace ehdjet
