#include "auto_solver.hpp"

#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>
#include <vector>

namespace ehdjet::detail {
namespace {

/// Another solver must be cheaper by this factor to be worth a switch.
constexpr double worth_switching = 0.9;

class AutoSolver final : public CoulombSolver {
public:
  explicit AutoSolver(SolverOptions options)
      : options_(std::move(options))
      , costs_(options_.costs ? *options_.costs : CostModel::shipped()) {}

  void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) override {
    choose(q.size());
    solvers_[chosen_]->add_force(r, q, force);
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) override {
    choose(q.size());
    return solvers_[chosen_]->energy(r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override {
    return solvers_[chosen_] ? solvers_[chosen_]->coincident_pairs() : 0;
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override {
    return {.tolerance = options_.tolerance};
  }
  [[nodiscard]] std::string_view name() const override { return "auto"; }
  [[nodiscard]] std::string description() const override {
    if (charges_ == 0) return "auto, not yet called";
    const double direct = costs_.cost("direct", charges_, options_.tolerance);
    return fmt::format("auto: {}, at {} charges {:.2g} of the direct sum's time by the "
                       "cost model; {} switches",
                       solvers_[chosen_]->description(), charges_,
                       costs_.cost(priced_solvers[chosen_], charges_, options_.tolerance)
                           / direct,
                       switches_);
  }
  void tighten() override {
    ++tightened_;
    for (const auto& solver : solvers_)
      if (solver) solver->tighten();
  }

private:
  void choose(std::size_t n) {
    if (n == charges_ && solvers_[chosen_]) return;
    const std::string_view best = costs_.cheapest(n, options_.tolerance);
    const auto index = static_cast<std::size_t>(std::ranges::find(priced_solvers, best)
                                                - priced_solvers.begin());
    const double price = costs_.cost(best, n, options_.tolerance);
    const bool worth =
        charges_ == 0
        || price < worth_switching
                       * costs_.cost(priced_solvers[chosen_], n, options_.tolerance);
    charges_ = n;
    if (worth && (index != chosen_ || !solvers_[index])) {
      if (solvers_[chosen_]) ++switches_;
      chosen_ = index;
    }
    auto& solver = solvers_[chosen_];
    if (solver) return;
    SolverOptions options = options_;
    options.solver = priced_solvers[chosen_];
    options.check_every.reset();
    solver = make_coulomb_solver(options);
    for (std::size_t i = 0; i < tightened_; ++i) solver->tighten();
  }

  SolverOptions options_;
  CostModel costs_;
  std::array<std::unique_ptr<CoulombSolver>, priced_solvers.size()> solvers_; // as needed
  std::size_t chosen_ = 0, charges_ = 0, switches_ = 0, tightened_ = 0;
};

class CheckedSolver final : public CoulombSolver {
public:
  CheckedSolver(std::unique_ptr<CoulombSolver> solver, std::size_t every)
      : solver_(std::move(solver))
      , every_(every) {}

  void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) override {
    if (calls_++ % every_ != 0) {
      solver_->add_force(r, q, force);
      return;
    }
    const std::size_t n = q.size();
    for (auto& column : force_) column.assign(n, 0.0);
    auto& [x, y, z] = force_;
    solver_->add_force(r, q, {x, y, z});
    if (n > 1) check(r, q, {x, y, z});
    for (std::size_t i = 0; i < n; ++i)
      force.x[i] += x[i], force.y[i] += y[i], force.z[i] += z[i];
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) override {
    return solver_->energy(r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override {
    return solver_->coincident_pairs();
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override { return solver_->accuracy(); }
  [[nodiscard]] std::string_view name() const override { return solver_->name(); }
  [[nodiscard]] std::string description() const override {
    return fmt::format("{}; {} checks, largest error {:.2g}, {} above the tolerance",
                       solver_->description(), checks_, largest_, violations_);
  }
  void tighten() override { solver_->tighten(); }
  [[nodiscard]] std::optional<double> measured_error() const override { return error_; }
  [[nodiscard]] std::size_t violations() const override { return violations_; }

private:
  static constexpr std::size_t targets = 64;

  void check(ConstVec3View r, std::span<const double> q, ConstVec3View force) {
    error_ = sampled_error(r, q, force, targets).relative_l2;
    largest_ = std::max(largest_, error_);
    ++checks_;
    // The direct sum promises 0 and has its round-off.
    constexpr double round_off = 1e-12;
    if (error_ <= std::max(solver_->accuracy().tolerance, round_off)) return;
    ++violations_;
    solver_->tighten();
  }

  std::unique_ptr<CoulombSolver> solver_;
  std::size_t every_, calls_ = 0, checks_ = 0, violations_ = 0;
  double error_ = 0, largest_ = 0;
  std::array<std::vector<double>, 3> force_;
};

} // namespace

std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options) {
  return std::make_unique<AutoSolver>(options);
}

std::unique_ptr<CoulombSolver> make_checked_solver(std::unique_ptr<CoulombSolver> solver,
                                                   std::size_t every) {
  return std::make_unique<CheckedSolver>(std::move(solver), every);
}

} // namespace ehdjet::detail
