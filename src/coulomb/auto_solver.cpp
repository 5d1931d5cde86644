#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "clusters.hpp"
#include "solvers.hpp"

namespace ehdjet::detail {
namespace {

/// Another solver is chosen only if its cost is below this fraction of the present cost.
constexpr double worth_switching = 0.9;

class AutoSolver final : public CoulombSolver {
public:
  explicit AutoSolver(SolverOptions options)
      : options_(std::move(options))
      , costs_(options_.costs ? *options_.costs : CostModel::shipped(options_.simd)) {}

  void add_force(const PointCharges& charges, Vec3View force) override {
    choose(charges);
    used_ = chosen_;
    solver(used_).add_force(charges, force);
  }
  /// The cost of the direct sum follows from the number of pairs, that of the fast multipole method
  /// from the larger group. The choice for `add_force` does not change.
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    const std::size_t more = std::max(sources.size(), targets.size());
    const double pairs =
        2 * static_cast<double>(sources.size()) * static_cast<double>(targets.size());
    used_ = costs_.cost("direct", static_cast<std::size_t>(std::sqrt(pairs)),
                        options_.tolerance)
                    <= costs_.cost("fmm", more, options_.tolerance, crowding_)
                ? 0
                : 1;
    solver(used_).add_force_from(sources, targets, force);
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) const override {
    return make(costs_.cheapest(q.size(), options_.tolerance, crowding_))->energy(r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override {
    return solvers_[used_] ? solvers_[used_]->coincident_pairs() : 0;
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override {
    return {.tolerance = options_.tolerance, .norm = options_.norm};
  }
  [[nodiscard]] std::string_view name() const override { return "auto"; }
  [[nodiscard]] std::string description() const override {
    if (charges_ == 0 || !solvers_[chosen_]) return "auto, not yet called";
    const double direct = costs_.cost("direct", charges_, options_.tolerance);
    return fmt::format("auto: {}, at {} charges {:.2g} of the direct sum's time by the "
                       "cost model; {} switches",
                       solvers_[chosen_]->description(), charges_,
                       price_of(chosen_) / direct, switches_);
  }
  void tighten() override {
    ++tightened_;
    for (const auto& solver : solvers_)
      if (solver) solver->tighten();
  }
  void archive(const Archive& a) override {
    a("chosen", chosen_), a("charges", charges_), a("crowding", crowding_);
    a("calls", calls_), a("switches", switches_), a("tightened", tightened_);
    if (!a.is_reading()) return;
    constexpr std::size_t most_halvings = 1000; // of a double
    a.require("chosen", chosen_ < solvers_.size(), "is no Coulomb solver");
    a.require("crowding", std::isfinite(crowding_), "is not finite");
    a.require("tightened", tightened_ <= most_halvings, "is too much");
    for (auto& solver : solvers_) solver.reset();
    if (charges_ > 0) (void)solver(chosen_);
  }

private:
  [[nodiscard]] double price_of(std::size_t k) const {
    return costs_.cost(priced_solvers[k], charges_, options_.tolerance, crowding_);
  }
  /// Chooses again when the number of charges has changed, and at least once in 256 calls.
  void choose(const PointCharges& charges) {
    constexpr std::size_t most_calls = 256;
    if (charges.size() == charges_ && ++calls_ < most_calls) return;
    const bool first = charges_ == 0;
    charges_ = charges.size(), calls_ = 0;
    if (charges_ == 0) return;
    crowding_ = measure_.of(charges);
    const std::size_t other = first ? (price_of(0) <= price_of(1) ? 0 : 1) : 1 - chosen_;
    if (!first && !(price_of(other) < worth_switching * price_of(chosen_))) return;
    if (!first) ++switches_;
    chosen_ = other;
  }
  [[nodiscard]] std::unique_ptr<CoulombSolver> make(std::string_view name) const {
    SolverOptions options = options_;
    options.solver = name;
    options.check_every.reset();
    return make_coulomb_solver(options);
  }
  CoulombSolver& solver(std::size_t k) {
    if (!solvers_[k]) {
      solvers_[k] = make(priced_solvers[k]);
      for (std::size_t i = 0; i < tightened_; ++i) solvers_[k]->tighten();
    }
    return *solvers_[k];
  }

  SolverOptions options_;
  CostModel costs_;
  /// A solver is made when it is first used.
  std::array<std::unique_ptr<CoulombSolver>, priced_solvers.size()> solvers_;
  Crowding measure_;
  double crowding_ = 0;
  std::size_t chosen_ = 0, used_ = 0; ///< for `add_force`; in the last call
  std::size_t charges_ = 0, calls_ = 0, switches_ = 0, tightened_ = 0;
};

} // namespace

std::unique_ptr<CoulombSolver> make_auto_solver(const SolverOptions& options) {
  return std::make_unique<AutoSolver>(options);
}

} // namespace ehdjet::detail
