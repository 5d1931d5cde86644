#pragma once

#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/integrator.hpp"

#include <vector>

namespace ehdjet {

/// Explicit Runge-Kutta methods, one loop for all tableaus.
///
/// cost   : s evaluations a step (the derivative at the end of a step is the first stage of the
///          next one); dense output needs that derivative at once and the tableau's extra stages.
///          Memory: s + 3 vectors, allocated when the size of y grows
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
  double initial_step(OdeSystem& system, double t, std::span<const double> y) override;

private:
  void resize(std::size_t n);
  void evaluate_stage(OdeSystem& system, std::size_t k, double c,
                      const std::vector<double>& a);
  void evaluate_end(OdeSystem& system);
  double estimated_error();

  const ButcherTableau* method_;
  ErrorScale scale_;
  bool error_needs_end_ = false;

  std::vector<std::vector<double>> k_; // s stages, k_s, extra stages
  std::vector<double> stage_, y1_, error_;
  std::span<const double> y0_;
  double t_ = 0, h_ = 0;
  std::size_t judged_ = 0; // rows of each column
  bool first_known_ = false, end_known_ = false, extra_known_ = false;
};

} // namespace ehdjet
