#pragma once

#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/integrator.hpp"

#include <vector>

namespace ehdjet {

struct WeightedVectors;

/// Explicit Runge-Kutta methods, one loop for all tableaus.
///
/// cost   : s evaluations a step (the derivative at the end of a step is the first stage of the
///          next one); dense output needs that derivative at once and the tableau's extra stages.
///          Memory: s + 1 vectors, one more for each extra stage and one if there are any, one less if
///          nobody needs a stage again after the last one. Allocated when the size of y grows
/// source : Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993)
class RungeKutta final : public Integrator {
public:
  RungeKutta(const ButcherTableau& method, ErrorScale scale);

  [[nodiscard]] std::string_view name() const override { return method_->name; }
  [[nodiscard]] int order() const override { return method_->order; }
  [[nodiscard]] int error_order() const override { return method_->error_order; }

  StepOutcome attempt(OdeSystem& system, double t, double h,
                      std::span<const double> y) override;
  [[nodiscard]] std::span<const double> end_state() const override { return y1_; }
  [[nodiscard]] std::size_t worst_component() const override;
  void prepare_dense_output(OdeSystem& system) override;
  void dense_output(double theta, std::size_t first, std::span<double> out) const override;
  void commit(std::vector<double>& y) override;
  void restart() override { first_known_ = false; }
  [[nodiscard]] std::span<const double> end_rate() const override;
  void start_from_rate(std::span<const double> rate) override;
  void archive(const Archive& a) override;
  double initial_step(OdeSystem& system, double t, std::span<const double> y) override;

private:
  void resize(std::size_t n);
  /// k_j at `place`, which is overwritten.
  void evaluate_stage(OdeSystem& system, std::size_t j, const ButcherTableau::Stage& stage,
                      std::vector<double>& place);
  void evaluate_end(OdeSystem& system);
  [[nodiscard]] WeightedVectors weighted(double factor,
                                         const std::vector<double>& row) const;
  [[nodiscard]] double estimated_error() const;
  /// k_j, j = 0 ... s, then the extra stages.
  [[nodiscard]] std::vector<double>& k(std::size_t j) {
    return k_[j == method_->stages.size() ? end_ : j];
  }
  [[nodiscard]] const std::vector<double>& k(std::size_t j) const {
    return k_[j == method_->stages.size() ? end_ : j];
  }

  const ButcherTableau* method_;
  ErrorScale scale_;
  bool error_needs_end_ = false;

  std::vector<std::vector<double>> k_; // s stages, k_s, extra stages; see end_
  std::size_t end_;                    // the entry of k_ in which k_s is kept
  std::vector<double> y1_; // until the last stage is known: where it is evaluated
  std::vector<double> extra_stage_;
  std::span<const double> y0_;
  double t_ = 0, h_ = 0;
  std::size_t judged_ = 0; // rows of each column
  bool first_known_ = false, end_known_ = false, extra_known_ = false;
};

} // namespace ehdjet
