#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/force_term.hpp"

#include <memory>
#include <vector>

namespace ehdjet {

/// Mutual repulsion of all beads, nozzle, embryo and landed bead included (model 3), through
/// whichever solver the scene names.
class CoulombForce final : public ForceTerm {
public:
  explicit CoulombForce(std::unique_ptr<CoulombSolver> solver)
      : solver_(std::move(solver)) {}
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "Coulomb"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< of all pairs
  [[nodiscard]] double energy_change(const Stage& before, const Stage& after) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_force_on(std::span<const std::size_t> beads, const Stage& stage,
                    Vec3View force) override;
  [[nodiscard]] std::optional<TermReport> report() const override;
  void archive(const Archive& a) override {
    a("coincident_pairs", coincident_pairs_);
    solver_->archive(a.part("solver"));
  }

private:
  std::unique_ptr<CoulombSolver> solver_;
  std::uint64_t coincident_pairs_ = 0;
};

} // namespace ehdjet
