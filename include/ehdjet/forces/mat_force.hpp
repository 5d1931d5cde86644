#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/jet/plate.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

/// What the charges on an insulating collector do to the jet (model 5.2):
///
///     F_k = q_k k_C sum_j q_j exp(-(t - t_j)/tau) (r_k - r_j)/|r_k - r_j|^3,   r_j = s_j + U t
///
/// The mat stands still in its own coordinates: the jet is shifted instead, and all charges have the
/// same factor, so that nothing is done per charge of the mat but the sum itself. The solver keeps the tree
/// of the settled charges; the few recent ones are summed directly.
///
/// cost   : one call of CoulombSolver::add_force_from per evaluation, with sources that it knows, and
///          less than Mat::block pairs per bead
class MatForce final : public ForceTerm {
public:
  MatForce(const Plate& plate, std::optional<double> decay_time,
           std::unique_ptr<CoulombSolver> solver);
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "mat"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< sum q phi of the mat
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  /// Work of the plate that moves the mat, and the decay.
  void add_power(const Stage& stage, Exchange& exchange) override;
  void archive(const Archive& a) override { solver_->archive(a.part("solver")); }

private:
  PointCharges seen_by(const MatCharges& mat, double t, PointCharges jet);
  [[nodiscard]] double potential(const Stage& stage, std::size_t bead) const;

  Plate plate_;
  std::optional<double> decay_time_;            // tau [s]
  std::unique_ptr<CoulombSolver> solver_, few_; // of the settled and the recent charges
  std::vector<double> y_, z_, charge_, force_;  // of the jet, as the mat sees it
};

} // namespace ehdjet
