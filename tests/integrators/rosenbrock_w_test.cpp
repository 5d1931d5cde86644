#include "ehdjet/integrators/rosenbrock_w.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "support/linear_part.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Eigen::MatrixXd, Eigen::VectorXd;

const RosenbrockTableau& method() {
  return rosenbrock_tableaus().front();
}

ErrorScale lenient(std::size_t n) {
  return {.rtol = 1e3, .column_scale = std::vector<double>(n, 1.0)};
}

// Hairer & Wanner II, IV.7: for third order whatever J is, all of these hold for the row sums alpha
// and gamma.
TEST(RosenbrockW, weights_obey_the_conditions_of_order_for_any_jacobian) {
  for (const RosenbrockTableau& m : rosenbrock_tableaus()) {
    const std::size_t s = m.b.size();
    std::vector<double> alpha(s), gamma(s, m.gamma);
    for (std::size_t i = 0; i < s; ++i) {
      EXPECT_EQ(m.a[i].size(), i);
      EXPECT_EQ(m.g[i].size(), i);
      alpha[i] = std::accumulate(m.a[i].begin(), m.a[i].end(), 0.0);
      gamma[i] += std::accumulate(m.g[i].begin(), m.g[i].end(), 0.0);
    }
    const auto sum = [&](const std::vector<double>& b, auto term) {
      double total = 0;
      for (std::size_t i = 0; i < s; ++i) total += b[i] * term(i);
      return total;
    };
    const auto row = [&](const std::vector<std::vector<double>>& matrix, double diagonal,
                         const std::vector<double>& v) {
      return [&matrix, diagonal, &v](std::size_t i) {
        double total = diagonal * v[i];
        for (std::size_t j = 0; j < i; ++j) total += matrix[i][j] * v[j];
        return total;
      };
    };
    for (const auto& b : {m.b, m.embedded}) {
      EXPECT_NEAR(sum(b, [](std::size_t) { return 1.0; }), 1, 1e-14);
      EXPECT_NEAR(sum(b, [&](std::size_t i) { return alpha[i]; }), 1. / 2, 1e-14);
      EXPECT_NEAR(sum(b, [&](std::size_t i) { return gamma[i]; }), 0, 1e-14);
    }
    EXPECT_NEAR(sum(m.b, [&](std::size_t i) { return alpha[i] * alpha[i]; }), 1. / 3,
                1e-14);
    EXPECT_NEAR(sum(m.b, row(m.a, 0, alpha)), 1. / 6, 1e-14);
    EXPECT_NEAR(sum(m.b, row(m.a, 0, gamma)), 0, 1e-14);
    EXPECT_NEAR(sum(m.b, row(m.g, m.gamma, alpha)), 0, 1e-14);
    EXPECT_NEAR(sum(m.b, row(m.g, m.gamma, gamma)), 0, 1e-14);
  }
}

/// A pendulum that is pushed: nothing in it is linear or autonomous.
StiffSystem pendulum(const MatrixXd& j) {
  return {[](double t, std::span<const double> y, std::span<double> rate) {
            rate[0] = y[1], rate[1] = -std::sin(y[0]) * (1 + 0.3 * std::cos(3 * t));
          },
          [j](double, std::span<const double>) { return j; },
          [](double, std::span<const double>) { return VectorXd::Zero(2); }};
}

std::vector<double> march_through(StiffSystem& system, std::vector<double> y, double end,
                                  int n) {
  RosenbrockW integrator(method(), lenient(y.size()));
  const double h = end / n;
  for (int i = 0; i < n; ++i) {
    EXPECT_LE(integrator.attempt(system, i * h, h, y).error, 1);
    integrator.commit(y);
  }
  return y;
}

TEST(RosenbrockW, has_its_order_with_any_matrix_for_a_jacobian) {
  const MatrixXd none = MatrixXd::Zero(2, 2);
  const MatrixXd near = (MatrixXd(2, 2) << 0, 1, -1, 0).finished();
  const MatrixXd wrong = (MatrixXd(2, 2) << -3, 0.5, 2, 1).finished();
  for (const MatrixXd& j : {none, near, wrong}) {
    StiffSystem system = pendulum(j);
    const auto exact = march_through(system, {1, 0}, 2, 20000);
    const auto error = [&](int n) {
      const auto y = march_through(system, {1, 0}, 2, n);
      return std::hypot(y[0] - exact[0], y[1] - exact[1]);
    };
    EXPECT_NEAR(std::log2(error(200) / error(400)), 3, 0.1) << j;
  }
}

/// y' = -rate (y - cos t): y = cos t to 1/rate.
StiffSystem chase(double rate) {
  return {
      [rate](double t, std::span<const double> y, std::span<double> out) {
        out[0] = -rate * (y[0] - std::cos(t)) - std::sin(t);
      },
      [rate](double, std::span<const double>) { return MatrixXd::Constant(1, 1, -rate); },
      [rate](double t, std::span<const double>) {
        return VectorXd::Constant(1, -rate * std::sin(t) - std::cos(t));
      }};
}

// A prescribed solution is the hardest for one-step methods: second order is left in the limit.
TEST(RosenbrockW, follows_what_is_stiff) {
  for (const double rate : {1.0, 1e3, 1e12}) {
    StiffSystem system = chase(rate);
    const auto error = [&](int n) {
      return std::abs(march_through(system, {1}, 2, n)[0] - std::cos(2));
    };
    EXPECT_LE(error(20), 1e-3) << rate;
    EXPECT_GE(std::log2(error(20) / error(40)), rate < 10 ? 2.8 : 1.6) << rate;
  }
}

TEST(RosenbrockW, forgets_a_stiff_transient_in_one_step) {
  StiffSystem system = chase(1e12);
  std::vector<double> y{100};
  RosenbrockW integrator(method(), lenient(1));
  (void)integrator.attempt(system, 0, 0.01, y);
  EXPECT_NEAR(integrator.end_state()[0], std::cos(0.01), 1e-6);
}

TEST(RosenbrockW, dense_output_joins_the_ends_and_is_of_second_order) {
  StiffSystem system = pendulum((MatrixXd(2, 2) << 0, 1, -1, 0).finished());
  const auto middle_error = [&](double h) {
    std::vector<double> y{1, 0.3}, at(2);
    RosenbrockW integrator(method(), lenient(2));
    (void)integrator.attempt(system, 0, h, y);
    integrator.prepare_dense_output(system);
    integrator.dense_output(0, 0, at);
    EXPECT_EQ(at[0], y[0]);
    integrator.dense_output(1, 0, at);
    EXPECT_NEAR(at[0], integrator.end_state()[0], 1e-14);
    EXPECT_NEAR(at[1], integrator.end_state()[1], 1e-14);
    std::vector<double> one(1);
    integrator.dense_output(1, 1, one);
    EXPECT_EQ(one[0], at[1]);
    integrator.dense_output(0.4, 0, at);
    const auto exact = march_through(system, {1, 0.3}, 0.4 * h, 2000);
    return std::hypot(at[0] - exact[0], at[1] - exact[1]);
  };
  EXPECT_NEAR(std::log2(middle_error(0.02) / middle_error(0.01)), 3, 0.2);
}

TEST(RosenbrockW, another_attempt_saves_an_evaluation_and_the_jacobian) {
  StiffSystem system = chase(100), other = chase(100);
  std::vector<double> y{1.2}, z{1.2};
  RosenbrockW integrator(method(), lenient(1)), fresh(method(), lenient(1));
  (void)integrator.attempt(system, 0.3, 0.2, y);
  EXPECT_EQ(system.evaluations, 4);
  (void)integrator.attempt(system, 0.3, 0.05, y);
  EXPECT_EQ(system.evaluations, 7);
  EXPECT_EQ(system.linearizations, 1);
  (void)fresh.attempt(other, 0.3, 0.05, z);
  EXPECT_EQ(integrator.end_state()[0], fresh.end_state()[0]);
  integrator.commit(y);
  (void)integrator.attempt(system, 0.35, 0.05, y);
  EXPECT_EQ(system.linearizations, 2);
}

TEST(RosenbrockW, an_error_that_is_no_number_is_not_accepted) {
  StiffSystem system(
      {[](double, std::span<const double> y, std::span<double> rate) {
        rate[0] = y[0] > 1.05 ? std::numeric_limits<double>::quiet_NaN() : 1;
      }},
      [](double, std::span<const double>) { return MatrixXd::Zero(1, 1); },
      [](double, std::span<const double>) { return VectorXd::Zero(1); });
  std::vector<double> y{1};
  RosenbrockW integrator(method(), lenient(1));
  EXPECT_FALSE(integrator.attempt(system, 0, 0.5, y).error <= 1);
  EXPECT_TRUE(integrator.attempt(system, 0, 0.01, y).error <= 1);
}

} // namespace
} // namespace ehdjet
