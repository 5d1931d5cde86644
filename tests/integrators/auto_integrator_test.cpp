#include "ehdjet/integrators/auto_integrator.hpp"
#include "ehdjet/integrators/step_size_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "support/linear_part.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Eigen::MatrixXd, Eigen::VectorXd;

/// y' = -rate(t) (y - cos t) - sin t, followed by cos t once the transient is over.
StiffSystem chase(const std::function<double(double)>& rate) {
  return {[rate](double t, std::span<const double> y, std::span<double> out) {
            out[0] = -rate(t) * (y[0] - std::cos(t)) - std::sin(t);
          },
          [rate](double t, std::span<const double>) {
            return MatrixXd::Constant(1, 1, -rate(t));
          },
          [rate](double t, std::span<const double>) {
            return VectorXd::Constant(1, -rate(t) * std::sin(t) - std::cos(t));
          }};
}

struct Outcome {
  std::vector<double> states;
  std::vector<std::string_view> methods; // those in use, without repetition
  int steps = 0;
};

Outcome follow(Integrator& integrator, StiffSystem& system, double end) {
  Outcome outcome;
  std::vector<double> y{1.5};
  double t = 0, h = integrator.initial_step(system, 0, y);
  StepSizeControl control(integrator.error_order());
  while (t < end && outcome.steps < 100000) {
    h = std::min(h, end - t);
    const double error = integrator.attempt(system, t, h, y).error;
    control.set_error_order(integrator.error_order());
    if (error > 1) {
      h = control.after_rejected(h, error);
      continue;
    }
    integrator.commit(y);
    t += h;
    h = control.after_accepted(h, error);
    outcome.states.push_back(y[0]);
    if (outcome.methods.empty() || outcome.methods.back() != integrator.method_in_use())
      outcome.methods.push_back(integrator.method_in_use());
    ++outcome.steps;
  }
  return outcome;
}

const ErrorScale scale{.rtol = 1e-5, .column_scale = {1}};
using Names = std::vector<std::string_view>;

TEST(AutoIntegrator, is_the_explicit_pair_bit_by_bit_where_nothing_is_stiff) {
  StiffSystem system = chase([](double) { return 2.0; });
  AutoIntegrator chooses(scale);
  RungeKutta pair(butcher_tableau("dormand-prince"), scale);
  const Outcome a = follow(chooses, system, 20);
  const long evaluations = system.evaluations;
  system.evaluations = 0;
  const Outcome b = follow(pair, system, 20);
  EXPECT_EQ(a.states, b.states);
  EXPECT_EQ(evaluations, system.evaluations);
  EXPECT_EQ(a.methods, Names{"dormand-prince"});
  EXPECT_LE(system.linearizations, a.steps / 4); // what looking costs
}

TEST(AutoIntegrator, starts_implicit_if_its_first_step_would_be_unstable) {
  StiffSystem system = chase([](double) { return 1e9; });
  AutoIntegrator chooses(scale);
  const Outcome outcome = follow(chooses, system, 20);
  EXPECT_EQ(outcome.methods.back(), "ros34pw2");
  EXPECT_LE(outcome.steps, 1000);
  EXPECT_NEAR(outcome.states.back(), std::cos(20), 1e-3);
}

TEST(AutoIntegrator, changes_when_stability_comes_to_rule_and_back_when_it_no_longer_does) {
  const auto rate = [](double t) { return t > 5 && t < 15 ? 1e5 : 1.0; };
  StiffSystem system = chase(rate);
  AutoIntegrator chooses(scale);
  const Outcome outcome = follow(chooses, system, 25);
  EXPECT_EQ(outcome.methods, (Names{"dormand-prince", "ros34pw2", "dormand-prince"}));
  EXPECT_NEAR(outcome.states.back(), std::cos(25), 1e-2);
  // The pair alone needs 10 * 1e5 / 3.3 steps of the middle.
  EXPECT_LE(outcome.steps, 1000);
}

TEST(AutoIntegrator, reports_the_order_of_the_method_in_use) {
  StiffSystem system = chase([](double) { return 1e9; });
  AutoIntegrator chooses(scale);
  EXPECT_EQ(chooses.error_order(), 5);
  std::vector<double> y{1};
  (void)chooses.attempt(system, 0, 0.1, y);
  EXPECT_EQ(chooses.name(), "auto");
  EXPECT_EQ(chooses.method_in_use(), "ros34pw2");
  EXPECT_EQ(chooses.error_order(), 3);
}

} // namespace
} // namespace ehdjet
