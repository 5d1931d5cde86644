#pragma once

#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"
#include "ehdjet/integrators/step_size_control.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Runs the integrators on ordinary differential equations that tests write down.
namespace ehdjet::test {

/// dy/dt = f(t, y) given as a function.
class FunctionSystem final : public OdeSystem {
public:
  using Rhs = std::function<void(double, std::span<const double>, std::span<double>)>;
  explicit FunctionSystem(Rhs f)
      : f_(std::move(f)) {}
  void evaluate(double t, std::span<const double> y, std::span<double> rate) override {
    ++evaluations;
    f_(t, y, rate);
  }
  long evaluations = 0;

private:
  Rhs f_;
};

/// y at t1 after n equal steps.
inline std::vector<double> march(std::string_view method, OdeSystem& system,
                                 std::vector<double> y, double t0, double t1, int n) {
  RungeKutta rk(butcher_tableau(method),
                {.rtol = 1e3, .column_scale = std::vector<double>(y.size(), 1.0)});
  const double h = (t1 - t0) / n;
  for (int i = 0; i < n; ++i) {
    if (!(rk.attempt(system, t0 + i * h, h, y).error <= 1))
      throw std::runtime_error("march: a step failed");
    rk.commit(y);
  }
  return y;
}

/// y at t1 with steps that suit the tolerance; `scale` per component.
inline std::vector<double> march_adaptively(std::string_view method, OdeSystem& system,
                                            std::vector<double> y, double t0, double t1,
                                            const ErrorScale& scale) {
  RungeKutta rk(butcher_tableau(method), scale);
  StepSizeControl control(rk.error_order());
  double t = t0, h = std::min(t1 - t0, rk.initial_step(system, t0, y));
  while (t < t1) {
    const bool last = h >= t1 - t;
    if (last) h = t1 - t;
    const double error = rk.attempt(system, t, h, y).error;
    if (error <= 1) {
      rk.commit(y);
      t = last ? t1 : t + h;
      h = control.after_accepted(h, error);
    } else {
      h = control.after_rejected(h, error);
      if (!(h > 1e-18))
        throw std::runtime_error("march: the step collapses at " + std::to_string(t));
    }
  }
  return y;
}

} // namespace ehdjet::test
