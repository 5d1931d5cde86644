#pragma once

#include "ehdjet/dynamics/chain_jacobian.hpp"
#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/integrators/ode_system.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/nozzle.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

/// Beads that are held in place besides those the events hold.
struct HeldEnds {
  bool first = false, last = false;
};

/// The equations of motion of a jet (model 2): the right-hand side, composed of force terms.
///
///     dr_k/dt = v_k,   m_k dv_k/dt = sum of the terms' forces,   d sigma_k/dt from the rheology
///
/// Beads that do not move freely have rate zero: the nozzle and an embryo, whose places are
/// prescribed at each stage time, held ends, and landed beads.
///
/// Its stiff part are the terms' answers to a change of a link, with dr/dt = v (model 6). Charges
/// have no part in it.
class JetDynamics final : public OdeSystem, private StiffPart {
public:
  void add(std::unique_ptr<ForceTerm> term) { terms_.push_back(std::move(term)); }
  void set_rheology(std::unique_ptr<Rheology> rheology);
  /// Bead 0 is the nozzle and beads are born there. Without it bead 0 is an ordinary bead.
  void set_nozzle(const Nozzle& nozzle, const Embryo& embryo) {
    nozzle_ = {nozzle, embryo};
  }
  void hold(HeldEnds ends) { ends_ = ends; }

  /// Must be called after the chain (not merely its state) has changed.
  void bind(const JetState& jet);

  void evaluate(double t, std::span<double> y, std::span<double> rate) override;
  [[nodiscard]] StiffPart* stiff_part() override { return this; }
  /// Puts the nozzle and an embryo in their places at time t.
  void prescribe(double t, std::span<double> y) const;

  [[nodiscard]] bool has_stress() const { return rheology_ != nullptr; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }
  /// Pairs of beads at zero distance that were skipped so far, all evaluations together.
  [[nodiscard]] std::uint64_t coincident_pairs() const;
  /// Comparisons of the Coulomb force with the direct sum; none if nobody checks.
  [[nodiscard]] std::optional<CoulombChecks> coulomb_checks() const;
  [[nodiscard]] const std::vector<std::unique_ptr<ForceTerm>>& terms() const {
    return terms_;
  }

  /// What is not bound with the chain.
  void archive(const Archive& a);

  /// Why a step of size h failed near this state, for a message to the user: the first bead and
  /// term whose force or rate is not a number or, if there is none, the term that pulls
  /// hardest at `bead`.
  [[nodiscard]] std::string diagnosis(double t, std::span<const double> y,
                                      std::size_t bead);

private:
  struct Source {
    Nozzle nozzle;
    Embryo embryo;
  };
  /// A bead beyond the absorbing plane, as it was before it was put back.
  struct Passed {
    std::size_t bead;
    Vec3 position;
    double charge;
  };
  void linearize(double t, std::span<const double> y) override;
  void factorize(double eta) override { jacobian_.factorize(eta, mass_); }
  void solve(std::span<double> x) const override { jacobian_.solve(x); }
  void add_time_derivative(double factor, std::span<double> out) const override;
  [[nodiscard]] Modes fastest_modes() const override;

  void set_stage(double t, std::span<double> y);
  /// Puts beads that have passed an absorbing plane since the step began back to where they
  /// crossed it:  r - v (x - h)/v_x                                         (model 5)
  void absorb(std::span<double> y);
  void let_pass(std::span<double> y);

  std::vector<std::unique_ptr<ForceTerm>>
      terms_; // the rheology, which also has a force, last
  Rheology* rheology_ = nullptr;
  std::optional<Source> nozzle_;
  HeldEnds ends_;

  Stage stage_;
  std::vector<double> mass_, inverse_mass_, volume_;
  std::vector<double> charge_; // as they act; an embryo's is part of its full charge
  double embryo_charge_ = 0;   // its full charge [C]
  std::vector<LandedBead> landed_;
  std::vector<std::size_t> held_;   // beads that do not move freely
  std::vector<std::size_t> frozen_; // those whose link keeps its stress
  bool has_embryo_ = false;
  std::optional<double> absorbing_plane_; // [m]
  std::vector<Passed> passed_;            // in the present evaluation, from the end on
  std::uint64_t evaluations_ = 0;
  ChainJacobian jacobian_;   // of the last linearization; empty as long as there was none
  double linearized_at_ = 0; // [s]
};

} // namespace ehdjet
