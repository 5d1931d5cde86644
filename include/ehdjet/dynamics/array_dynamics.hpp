#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/forces/shared_coulomb.hpp"
#include "ehdjet/integrators/ode_system.hpp"
#include "ehdjet/jet/bead_range.hpp"
#include "ehdjet/jet/jet_axis.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// The equations of motion of several jets side by side (model 9). One Coulomb sum goes over the beads
/// of all jets. Besides that each jet moves by its own JetDynamics, in coordinates from its own axis.
///
/// shapes : y = [x | y | z | vx | ...]; each column has the beads of jet 0, then those of jet 1, ...
/// The stiff part is that of each jet alone: pairs of charges have no part in it.
class ArrayDynamics final : public OdeSystem, private StiffPart {
public:
  explicit ArrayDynamics(std::unique_ptr<CoulombSolver> solver)
      : solver_(std::move(solver)) {}
  /// `coulomb`: the term of that jet that takes its part of the sum. All jets have the same columns.
  void add(std::unique_ptr<JetDynamics> jet, std::shared_ptr<SharedCoulomb> coulomb,
           const JetAxis& axis);

  [[nodiscard]] std::size_t jets() const { return parts_.size(); }
  [[nodiscard]] JetDynamics& jet(std::size_t j) { return *parts_[j].dynamics; }
  [[nodiscard]] const JetDynamics& jet(std::size_t j) const { return *parts_[j].dynamics; }
  [[nodiscard]] const JetAxis& axis(std::size_t j) const { return parts_[j].axis; }

  /// Must be called after the chain of jet j (not merely its state) has changed.
  void bind(std::size_t j, const JetState& jet);
  /// Where the beads of jet j are in each column of y.
  [[nodiscard]] BeadRange rows(std::size_t j) const { return parts_[j].rows; }
  [[nodiscard]] std::size_t beads() const { return parts_.back().rows.end; }
  /// Copies the columns of jet j out of those of all jets, and back.
  void take(std::span<const double> all, std::size_t j, std::span<double> own) const;
  void put(std::span<const double> own, std::size_t j, std::span<double> all) const;

  void prescribe(double t, std::span<double> y) const override;
  void evaluate(double t, std::span<const double> y, std::span<double> rate) override;
  [[nodiscard]] StiffPart* stiff_part() override { return this; }

  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }
  /// Pairs of beads at zero distance, which are skipped: the most in one evaluation so far.
  [[nodiscard]] std::uint64_t coincident_pairs() const { return coincident_pairs_; }
  [[nodiscard]] const CoulombSolver& solver() const { return *solver_; }
  /// What is not bound with the chains.
  void archive(const Archive& a);

private:
  struct Part {
    std::unique_ptr<JetDynamics> dynamics;
    std::shared_ptr<SharedCoulomb> coulomb;
    JetAxis axis;
    BeadRange rows = {0, 0};
    std::vector<double> state = {}, rate = {}; // the jet's own columns
  };

  void gather_charges(double t, std::span<const double> y);
  void linearize(double t, std::span<const double> y) override;
  void factorize(double eta) override;
  void solve(std::span<double> x) const override;
  void add_time_derivative(double factor, std::span<double> out) const override;
  [[nodiscard]] Modes fastest_modes() const override;
  template <class Change>
  void change_each(std::span<double> all, const Change& change) const;

  std::unique_ptr<CoulombSolver> solver_;
  std::vector<Part> parts_;
  // Of all beads, as they act.
  std::vector<double> place_, charge_, force_;
  std::vector<std::uint8_t> moves_;
  mutable std::vector<double> room_; // the columns of one jet
  std::uint64_t evaluations_ = 0, coincident_pairs_ = 0;
};

} // namespace ehdjet
