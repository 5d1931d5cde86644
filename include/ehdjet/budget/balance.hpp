#pragma once

#include "ehdjet/dynamics/acting_chain.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/jet/exchange.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// Energies and momentum of a jet.
struct JetEnergies {
  double kinetic = 0; ///< of beads that move freely [J]
  std::vector<double>
      stored; ///< energies of one name together, in the order of the terms [J]
  Vec3 momentum = Vec3::Zero(); ///< sum m v of beads that move freely [kg m/s]
  double momentum_size = 0;     ///< sum m |v| of the same [kg m/s]

  [[nodiscard]] double total() const;
};

/// The balance of a jet at one instant while its chain stays (model 8):
///
///     dE/dt = sum of the channels' energies,  dP/dt = sum of their momenta
///
/// It is a sum over the force terms, each of which accounts for itself, over what holds or leads
/// beads, over the vapour of a jet that dries, and over the events.
///
/// cost : `flows` O(n), and O(n) per bead that does not move freely; `energies` what the energies of
///        the terms cost. In a jet that dries `flows` computes twice those that depend on volumes
class Balance {
public:
  /// Of the terms and constraints of `dynamics`, which outlives the balance, with channels for these
  /// events.
  Balance(const JetDynamics& dynamics, std::span<const std::unique_ptr<Event>> events);

  [[nodiscard]] std::span<const Channel> channels() const { return channels_; }
  /// Index of the channel of that name. errors : ContractViolation if there is none
  [[nodiscard]] std::size_t channel(const std::string& name) const;
  /// Name and meaning of the stored energies, in the order of JetEnergies::stored.
  [[nodiscard]] std::span<const TermAccount> stores() const { return stores_; }

  /// Puts the nozzle and an embryo in their places at the jet's time.
  void prescribe(JetState& jet) const;
  [[nodiscard]] JetEnergies energies(const JetState& jet);
  /// What each channel brings in per second.
  [[nodiscard]] std::span<const Flow> flows(const JetState& jet);
  /// What an event has brought in. O(n) if it has left nearly all beads where they were.
  [[nodiscard]] Flow jump(const JetState& before, const JetState& after);
  /// Sums over the beads, and the energy stored by the terms with the columns `elastic_energy` and,
  /// if asked for, `coulomb_energy`, with those of the near field.
  [[nodiscard]] JetTotals totals(const JetState& jet, bool with_coulomb_energy);

private:
  void add_channel(const Channel& channel);
  /// The chain of that jet, ready to be looked at.
  static const Stage& look_at(ActingChain& chain, const JetState& jet);
  static JetEnergies motion_of(const ActingChain& chain);
  void add_flows(const ActingChain& chain, ForceTerm& term, const TermAccount& account,
                 Exchange& exchange);

  /// Of what evaporates. Replaces the stage of `chain_`.
  Flow drying(const JetState& jet);
  /// Kinetic energy, all stored ones that depend on masses or volumes, and momentum.
  Flow content_of_masses(double t, std::span<const double> y);

  const JetDynamics& dynamics_;
  std::vector<Channel> channels_;
  std::vector<TermAccount> accounts_; // of all terms
  std::vector<std::size_t> own_;      // channel of each term, if it has one
  std::vector<TermAccount> stores_;   // of the terms that store energy, one per name
  std::vector<std::size_t> store_of_; // of each term, if it stores energy
  std::array<std::size_t, supports> support_channel_{};
  std::optional<std::size_t> drying_; // the term by which the jet dries
  ActingChain chain_, chain_before_;
  std::vector<Support> support_of_;
  std::vector<double> force_, rates_, changed_;
  std::vector<Flow> flows_;
};

} // namespace ehdjet
