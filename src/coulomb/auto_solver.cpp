#include "auto_solver.hpp"

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
      , costs_(options_.costs ? *options_.costs : CostModel::shipped(options_.simd)) {}

  void add_force(const PointCharges& charges, Vec3View force) override {
    choose(charges.size());
    solvers_[chosen_]->add_force(charges, force);
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    choose(std::max(sources.size(), targets.size()));
    solvers_[chosen_]->add_force_from(sources, targets, force);
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) const override {
    SolverOptions options = options_;
    options.solver = costs_.cheapest(q.size(), options_.tolerance);
    options.check_every.reset();
    return make_coulomb_solver(options)->energy(r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override {
    return solvers_[chosen_] ? solvers_[chosen_]->coincident_pairs() : 0;
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override {
    return {.tolerance = options_.tolerance, .norm = options_.norm};
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
  void archive(const Archive& a) override {
    a("chosen", chosen_), a("charges", charges_);
    a("switches", switches_), a("tightened", tightened_);
    if (!a.is_reading()) return;
    if (chosen_ >= solvers_.size())
      throw InputError("the checkpoint is damaged: there is no such Coulomb solver");
    for (auto& solver : solvers_) solver.reset();
    if (charges_ > 0) make_chosen();
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
    if (!solvers_[chosen_]) make_chosen();
  }
  void make_chosen() {
    SolverOptions options = options_;
    options.solver = priced_solvers[chosen_];
    options.check_every.reset();
    solvers_[chosen_] = make_coulomb_solver(options);
    for (std::size_t i = 0; i < tightened_; ++i) solvers_[chosen_]->tighten();
  }

  SolverOptions options_;
  CostModel costs_;
  std::array<std::unique_ptr<CoulombSolver>, priced_solvers.size()> solvers_; // as needed
  std::size_t chosen_ = 0, charges_ = 0, switches_ = 0, tightened_ = 0;
};

} // namespace

std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options) {
  return std::make_unique<AutoSolver>(options);
}

} // namespace ehdjet::detail
