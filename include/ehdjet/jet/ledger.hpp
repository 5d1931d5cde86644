#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace ehdjet {

/// What has entered and left the chain since t = 0. The beads of the start count as inserted;
/// the nozzle bead does not. An embryo counts from its creation (model 4.1).
struct Ledger {
  std::uint64_t inserted_beads = 0, removed_beads = 0;
  CompensatedSum inserted_mass, removed_mass;     ///< [kg]
  CompensatedSum inserted_charge, removed_charge; ///< [C]
  CompensatedSum inserted_volume, removed_volume; ///< [m^3]
  double release_speed = 0;    ///< speed given to the last released bead [m/s]
  double impact_speed = 0;     ///< of the last landed bead at its landing [m/s]
  double collector_radius = 0; ///< of the link of the last landed bead at its landing [m]
};

void archive(const Archive& a, Ledger& ledger);

/// What has entered and left several jets. Speeds and radius are means over the jets that have them.
[[nodiscard]] Ledger sum_of(std::span<const Ledger> ledgers);

/// A bead that has left the chain: one element of the deposited fibre (model 5).
struct DepositedBead {
  double time = 0;         ///< of its landing [s]
  double removal_time = 0; ///< when it left the chain [s]
  /// Position on the collector, in coordinates that are fixed to it (Plate::fixed), velocity and stress
  /// at landing.
  Bead bead;
  double landing_radius = 0; ///< of its link at its landing [m]
  double radius = 0;         ///< of its link when it left the chain [m]
};

/// Sums over a chain's beads, or their change.
struct JetTotals {
  double mass = 0, charge = 0, volume = 0; ///< all beads but bead 0 [kg], [C], [m^3]
  Vec3 momentum = Vec3::Zero();            ///< of beads that move freely [kg m/s]
  double kinetic_energy = 0;               ///< of the same [J]
  double elastic_energy = 0;               ///< stored by the fluid (model 2) [J]
  double coulomb_energy = 0;               ///< 0 if nobody asked for it [J]
};

/// What one refinement did to the chain (model 7).
struct RefinementRecord {
  double time = 0;                               ///< [s]
  std::size_t kept = 0;                          ///< bead s: beads 0 ... s are untouched
  std::size_t beads_before = 0, beads_after = 0; ///< of the chain, bead 0 included
  JetTotals change;
  double worst_link = 0; ///< max |l/l* - 1| over the new links
};

/// Method of an integrator that chooses among several.
struct MethodRecord {
  std::string_view in_use;   ///< name of the method of the last step
  double since = 0;          ///< its first step began then [s]
  std::uint64_t changes = 0; ///< of the method so far
};

/// Of a run that can take steps with two rates.
struct TwoRateRecord {
  std::uint64_t steps = 0;             ///< macro steps
  std::uint64_t inner_evaluations = 0; ///< of the right-hand side of the inner beads
  std::uint64_t inner_beads = 0;       ///< how many there are now
  std::string_view method = {};        ///< of the last macro step
  /// Coulomb sums so far with everything included: pairs over all pairs of the chain.
  double full_sums = 0;
};

/// Cost of the run so far.
struct RunStatistics {
  /// Of the right-hand side; with two rates, of the downstream beads.
  std::uint64_t evaluations = 0;
  std::uint64_t steps = 0;    ///< accepted
  std::uint64_t rejected = 0; ///< attempts
  std::uint64_t insertions = 0, releases = 0, landings = 0;
  std::optional<std::uint64_t> refinements; ///< none in a run that does not refine
  std::optional<MethodRecord> method;       ///< none if the scene names a method
  std::optional<TwoRateRecord> two_rates;   ///< none if the scene has one rate
  /// Of the Coulomb force at its last check, relative; none without checks.
  std::optional<double> coulomb_error;
  std::uint64_t coulomb_violations = 0; ///< checks that found more than the tolerance
  std::uint64_t coincident_pairs = 0;   ///< at zero distance, skipped: most per evaluation
  double shortest_step = std::numeric_limits<double>::infinity(); ///< [s]
  double longest_step = 0;                                        ///< [s]
  double wall_time = 0;                                           ///< [s]
};

/// Not the names of methods in use, which the integrators know.
void archive(const Archive& a, RunStatistics& statistics);

} // namespace ehdjet
