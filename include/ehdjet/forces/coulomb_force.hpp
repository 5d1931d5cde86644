#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/force_term.hpp"

#include <memory>

namespace ehdjet {

/// Mutual repulsion of all beads, nozzle, embryo and landed bead included (model 3), through
/// whichever solver the scene names.
class CoulombForce final : public ForceTerm {
public:
  explicit CoulombForce(std::unique_ptr<CoulombSolver> solver)
      : solver_(std::move(solver)) {}
  void add_force(const Stage& stage, Vec3View force) override {
    solver_->add_force(stage.columns.position(), stage.charge, force);
    coincident_pairs_ += solver_->coincident_pairs();
  }
  [[nodiscard]] std::string_view name() const override { return "Coulomb"; }
  [[nodiscard]] std::uint64_t coincident_pairs() const override {
    return coincident_pairs_;
  }
  [[nodiscard]] std::string method() const override { return solver_->description(); }
  [[nodiscard]] std::optional<CoulombChecks> checks() const override {
    return solver_->checks();
  }
  void archive(const Archive& a) override {
    a("coincident_pairs", coincident_pairs_);
    solver_->archive(a.part("solver"));
  }

private:
  std::unique_ptr<CoulombSolver> solver_;
  std::uint64_t coincident_pairs_ = 0;
};

} // namespace ehdjet
