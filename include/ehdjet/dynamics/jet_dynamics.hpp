#pragma once

#include "ehdjet/dynamics/acting_chain.hpp"
#include "ehdjet/dynamics/chain_jacobian.hpp"
#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/integrators/ode_system.hpp"
#include "ehdjet/jet/inflow.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

/// The equations of motion of a jet (model 2): the right-hand side, composed of force terms.
///
///     dr_k/dt = v_k,   m_k dv_k/dt = sum of the terms' forces,   d sigma_k/dt from the rheology
///
/// Beads that do not move freely have rate zero: the nozzle and an embryo, whose places are
/// prescribed at each stage time, held ends, and landed beads. A landed bead has the velocity of the
/// collector; its column of velocities keeps that of its impact.
///
/// Its stiff part are the terms' answers to a change of a link or of a velocity, with dr/dt = v
/// (model 6). Pairs of charges have no part in it.
class JetDynamics final : public OdeSystem, private StiffPart {
public:
  /// A term may belong to the equations of motion of several parts of one chain.
  void add(std::shared_ptr<ForceTerm> term) {
    terms_.push_back(std::move(term)), table_.reset();
  }
  /// Bead 0 is the nozzle and beads are born there. Without it bead 0 is an ordinary bead.
  void set_inflow(std::shared_ptr<const Inflow> inflow);
  void hold(HeldEnds ends);
  /// Beads that have landed act on no other bead.
  void ground_collector();
  /// Landed beads keep acting when they have left the chain.
  void insulate_collector();
  /// Landed beads move with the collector (model 5.1).
  void move_collector(const Vec3& velocity);
  /// Only a part of the chain moves freely, and rates are those of this part. If the head is led, the
  /// others feel only their own charges; a part whose tail is led also feels those of the tail.
  void lead(const LedParts& led);

  /// Must be called after the chain (not merely its state) has changed.
  void bind(const JetState& jet);

  void evaluate(double t, std::span<const double> y, std::span<double> rate) override {
    evaluate(t, y, rate, targets_, sources_);
  }
  /// The rates of some beads only, `targets`, under the Coulomb force of the charges `sources`.
  /// Other entries of `rate` get anything.
  void evaluate(double t, std::span<const double> y, std::span<double> rate,
                BeadRange targets, BeadRange sources);
  /// The chain as the terms would see it in that state, valid until the next call. y must outlive it.
  const Stage& stage_at(double t, std::span<const double> y) { return chain_.at(t, y); }
  /// All but beads that have passed the collector and fly on, and the four above the first of them. The
  /// motion of those four has a kink, and that of the passed ones does not matter any more.
  [[nodiscard]] std::size_t judged_rows(std::span<const double> end) const override;
  [[nodiscard]] StiffPart* stiff_part() override { return this; }
  /// Puts the nozzle and an embryo in their places at time t.
  void prescribe(double t, std::span<double> y) const override;
  /// Whether fluid flows into link 1 all the time (model 4.3).
  [[nodiscard]] bool feeds() const { return feeds_; }

  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<std::shared_ptr<ForceTerm>>& terms() const {
    return terms_;
  }
  [[nodiscard]] const Constraints& constraints() const { return chain_.constraints(); }
  /// 1/m of the beads as they act at the last evaluation [1/kg].
  [[nodiscard]] std::span<const double> inverse_mass() const {
    return chain_.inverse_mass();
  }
  /// Pairs of beads at zero distance, which are skipped: the most in one evaluation so far.
  [[nodiscard]] std::uint64_t coincident_pairs() const;
  /// Comparisons of a force with an exact method; none if there are no comparisons.
  [[nodiscard]] std::optional<TermReport::Checks> checks() const;

  /// What is not bound with the chain.
  void archive(const Archive& a);

  /// Why a step of size h failed near this state, for a message to the user: the first bead and
  /// term whose force or rate is not a number or, if there is none, the term that pulls
  /// hardest at `bead`.
  [[nodiscard]] std::string diagnosis(double t, std::span<const double> y,
                                      std::size_t bead);

private:
  void let_fly_on(Vec3View force);
  void linearize(double t, std::span<const double> y) override;
  void factorize(double eta) override { jacobian_.factorize(eta, linearized_mass_); }
  void solve(std::span<double> x) const override { jacobian_.solve(x); }
  void add_time_derivative(double factor, std::span<double> out) const override;
  [[nodiscard]] Modes fastest_modes() const override;

  void bind_columns(std::shared_ptr<const BeadTable> table);

  std::vector<std::shared_ptr<ForceTerm>> terms_;
  std::shared_ptr<const BeadTable> table_; // that the terms are bound to
  std::vector<ForceTerm*> with_columns_;   // terms that add integrated columns
  std::vector<std::size_t> resting_;       // entries of the state whose rate is zero
  std::vector<std::size_t> carried_;       // beads that a moving collector takes along
  BeadRange targets_, sources_;            // of a part of the chain
  std::vector<double> own_force_;          // on beads that have passed the collector [N]
  std::shared_ptr<const Inflow> inflow_;
  bool feeds_ = false;
  ActingChain chain_;
  std::uint64_t evaluations_ = 0;
  ChainJacobian jacobian_;   // of the last linearization; empty as long as there was none
  double linearized_at_ = 0; // [s]
  /// At that time: masses of fed and of drying links differ from stage to stage [kg].
  std::vector<double> linearized_mass_;
};

} // namespace ehdjet
