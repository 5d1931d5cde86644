#pragma once

#include "ehdjet/integrators/ode_system.hpp"

#include <Eigen/Dense>

#include <functional>
#include <span>
#include <utility>

/// Ordinary differential equations with a Jacobian that tests write down.
namespace ehdjet::test {

/// dy/dt = f(t, y) with any matrix, the Jacobian or not, as its stiff part.
class StiffSystem : public OdeSystem, private StiffPart {
public:
  using Rhs = std::function<void(double, std::span<const double>, std::span<double>)>;
  using Jacobian = std::function<Eigen::MatrixXd(double, std::span<const double>)>;
  using TimeDerivative = std::function<Eigen::VectorXd(double, std::span<const double>)>;
  StiffSystem(Rhs f, Jacobian j, TimeDerivative dfdt)
      : f_(std::move(f))
      , jacobian_(std::move(j))
      , dfdt_(std::move(dfdt)) {}
  void evaluate(double t, std::span<const double> y, std::span<double> rate) override {
    ++evaluations;
    f_(t, y, rate);
  }
  StiffPart* stiff_part() override { return this; }
  long evaluations = 0, linearizations = 0;

private:
  void linearize(double t, std::span<const double> y) override {
    ++linearizations;
    j_ = jacobian_(t, y), ft_ = dfdt_(t, y);
  }
  void factorize(double eta) override {
    const auto n = j_.rows();
    lu_.compute(Eigen::MatrixXd::Identity(n, n) - eta * j_);
  }
  void solve(std::span<double> x) const override {
    Eigen::Map<Eigen::VectorXd> b(x.data(), static_cast<Eigen::Index>(x.size()));
    b = Eigen::VectorXd(lu_.solve(Eigen::VectorXd(b)));
  }
  void add_time_derivative(double factor, std::span<double> out) const override {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += factor * ft_[static_cast<Eigen::Index>(i)];
  }
  [[nodiscard]] Modes fastest_modes() const override {
    const Eigen::VectorXcd s = j_.eigenvalues();
    Modes modes{};
    for (const std::complex<double> v : s)
      if (std::abs(v) > std::abs(modes[0])) modes[0] = {v.real(), std::abs(v.imag())};
    return modes;
  }

  Rhs f_;
  Jacobian jacobian_;
  TimeDerivative dfdt_;
  Eigen::MatrixXd j_;
  Eigen::VectorXd ft_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

} // namespace ehdjet::test
