#include "ehdjet/coulomb/error_estimate.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "solvers.hpp"

namespace ehdjet::detail {
namespace {

class CheckedSolver final : public CoulombSolver {
public:
  CheckedSolver(std::unique_ptr<CoulombSolver> solver, std::size_t every)
      : solver_(std::move(solver))
      , every_(every) {}

  void add_force(const PointCharges& charges, Vec3View force) override {
    if (calls_++ % every_ != 0) {
      solver_->add_force(charges, force);
      return;
    }
    const std::size_t n = charges.size();
    for (auto& column : force_) column.assign(n, 0.0);
    auto& [x, y, z] = force_;
    solver_->add_force(charges, {x, y, z});
    if (n > 1) check(charges, {x, y, z});
    for (std::size_t i = 0; i < n; ++i)
      force.x[i] += x[i], force.y[i] += y[i], force.z[i] += z[i];
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    solver_->add_force_from(sources, targets, force);
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) const override {
    return solver_->energy(r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override {
    return solver_->coincident_pairs();
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override { return solver_->accuracy(); }
  [[nodiscard]] std::string_view name() const override { return solver_->name(); }
  [[nodiscard]] std::string description() const override {
    return fmt::format("{}; {} checks, largest error {:.2g}, {} above the tolerance",
                       solver_->description(), checks_.number, checks_.largest,
                       checks_.violations);
  }
  void tighten() override { solver_->tighten(); }
  void archive(const Archive& a) override {
    a("calls", calls_), a("checks", checks_.number), a("violations", checks_.violations);
    a("last_error", checks_.last), a("largest_error", checks_.largest);
    solver_->archive(a.part("solver"));
  }
  [[nodiscard]] std::optional<CoulombChecks> checks() const override { return checks_; }

private:
  static constexpr std::size_t sampled = 64;

  void check(const PointCharges& charges, ConstVec3View force) {
    const auto [tolerance, norm] = solver_->accuracy();
    checks_.last = sampled_error(charges, force, norm, sampled).in(norm);
    checks_.largest = std::max(checks_.largest, checks_.last);
    ++checks_.number;
    constexpr double round_off = 1e-12; // the tolerance of the direct sum is 0
    if (checks_.last <= std::max(tolerance, round_off)) return;
    ++checks_.violations;
    solver_->tighten();
  }

  std::unique_ptr<CoulombSolver> solver_;
  std::size_t every_, calls_ = 0;
  CoulombChecks checks_;
  std::array<std::vector<double>, 3> force_;
};

} // namespace

std::unique_ptr<CoulombSolver> make_checked_solver(std::unique_ptr<CoulombSolver> solver,
                                                   std::size_t every) {
  return std::make_unique<CheckedSolver>(std::move(solver), every);
}

} // namespace ehdjet::detail
