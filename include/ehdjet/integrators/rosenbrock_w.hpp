#pragma once

#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/integrators/rosenbrock_tableau.hpp"

#include <array>
#include <vector>

namespace ehdjet {

struct WeightedVectors;

/// Rosenbrock-W methods: steps are not limited by the rates in the system's stiff part.
///
/// cost   : s evaluations, s linear solutions, one linearization and one factorization a step;
///          an attempt repeated with another h saves an evaluation and the linearization
/// dense  : weights b_i(theta) of the stages that are already there; a local error O(h^3), as the
///          error estimate has, so that a state inside a step keeps the tolerance
/// order  : kept for any J; in the limit of instant relaxation second order where the stiff
///          components follow something that is prescribed, or start far from their equilibrium
/// source : Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996), IV.7
class RosenbrockW final : public Integrator {
public:
  RosenbrockW(const RosenbrockTableau& method, ErrorScale scale);

  [[nodiscard]] std::string_view name() const override { return method_->name; }
  [[nodiscard]] int order() const override { return method_->order; }
  [[nodiscard]] int error_order() const override { return method_->error_order; }

  StepOutcome attempt(OdeSystem& system, double t, double h,
                      std::span<const double> y) override;
  [[nodiscard]] std::span<const double> end_state() const override { return y1_; }
  [[nodiscard]] std::size_t worst_component() const override;
  void prepare_dense_output(OdeSystem& /*system*/) override {}
  void dense_output(double theta, std::size_t first, std::span<double> out) const override;
  void commit(std::vector<double>& y) override;
  void restart() override { start_known_ = false; }
  double initial_step(OdeSystem& system, double t, std::span<const double> y) override;

private:
  void resize(std::size_t n);
  void prepare_start(OdeSystem& system, double t, std::span<const double> y);
  [[nodiscard]] WeightedVectors weighted_error() const;

  const RosenbrockTableau* method_;
  ErrorScale scale_;
  std::vector<double> alpha_, gamma_; // row sums
  std::vector<std::array<double, 3>>
      dense_; // of b_i: coefficients of theta, theta^2, theta^3

  std::vector<std::vector<double>> k_;
  std::vector<double> start_rate_;
  std::vector<double> y1_; // until the last stage is known: where it is evaluated
  std::span<const double> y0_;
  double h_ = 0;
  std::size_t judged_ = 0;   // rows of each column
  bool start_known_ = false; // rate and linearization at the start of the step
};

} // namespace ehdjet
