#include "ehdjet/core/error.hpp"
#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/march.hpp"

namespace ehdjet {

// As a test's parameter.
static std::ostream& operator<<(std::ostream& os, const ButcherTableau& t) {
  return os << t.name;
}

namespace {

using namespace test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// y' = y cos t, so that a stage at the wrong time shows; y = exp(sin t) if y(0) = 1.
FunctionSystem swing() {
  return FunctionSystem([](double t, std::span<const double> y, std::span<double> rate) {
    rate[0] = y[0] * std::cos(t);
  });
}
double exact_swing(double t) {
  return std::exp(std::sin(t));
}

ErrorScale lenient(std::size_t columns = 1) {
  return {.rtol = 1e3, .column_scale = std::vector<double>(columns, 1.0)};
}

class Methods : public testing::TestWithParam<ButcherTableau> {
protected:
  [[nodiscard]] const ButcherTableau& method() const {
    return butcher_tableau(GetParam().name);
  }
};
INSTANTIATE_TEST_SUITE_P(All, Methods,
                         testing::ValuesIn(butcher_tableaus().begin(),
                                           butcher_tableaus().end()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(Methods, every_stage_stands_at_the_time_its_weights_add_up_to) {
  const ButcherTableau& m = method();
  const auto check = [](const ButcherTableau::Stage& stage) {
    double sum = 0, size = 0;
    for (const double a : stage.a) sum += a, size += std::abs(a);
    EXPECT_NEAR(sum, stage.c, 8 * epsilon * (size + 1)) << stage.c;
  };
  for (const auto& stage : m.stages) check(stage);
  for (const auto& stage : m.extra) check(stage);
}

TEST_P(Methods, weights_integrate_powers_below_the_order_exactly) {
  const ButcherTableau& m = method();
  const auto moment = [&](const std::vector<double>& weights, int power) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double c = i < m.stages.size() ? m.stages[i].c : 1.0; // the end of the step
      sum += weights[i] * std::pow(c, power);
    }
    return sum;
  };
  for (int p = 0; p < m.order; ++p) EXPECT_NEAR(moment(m.b, p), 1.0 / (p + 1), 1e-14) << p;
  EXPECT_GT(std::abs(moment(m.b, m.order) - 1.0 / (m.order + 1)), 1e-10);
  for (const auto& e : m.error) EXPECT_NEAR(moment(e, 0), 0, 1e-14);
}

TEST_P(Methods, the_error_falls_with_the_step_to_the_power_of_the_order) {
  const ButcherTableau& m = method();
  const int coarse_steps = m.order == 8 ? 8 : m.order == 5 ? 32 : 128;
  const auto error = [&](int n) {
    FunctionSystem system = swing();
    return std::abs(march(m.name, system, {exact_swing(0.3)}, 0.3, 2.7, n).front()
                    - exact_swing(2.7));
  };
  const double coarse = error(coarse_steps), fine = error(2 * coarse_steps);
  EXPECT_NEAR(std::log2(coarse / fine), m.order, m.order == 8 ? 0.5 : 0.1);
  EXPECT_GT(fine, 100 * epsilon) << "round-off";
}

// One step from the exact solution: interpolation and method each have a local error.
TEST_P(Methods, dense_output_has_the_order_it_claims_at_every_instant) {
  const ButcherTableau& m = method();
  const auto error = [&](double h) {
    FunctionSystem system = swing();
    RungeKutta rk(m, lenient());
    std::vector<double> y{exact_swing(0.3)};
    EXPECT_LE(rk.attempt(system, 0.3, h, y).error, 1);
    rk.prepare_dense_output(system);
    double worst = 0;
    for (const double theta : {0.07, 0.31, 0.5, 0.77, 0.96}) {
      double value = 0;
      rk.dense_output(theta, 0, {&value, 1});
      worst = std::max(worst, std::abs(value - exact_swing(0.3 + theta * h)));
    }
    return worst;
  };
  const bool has_own_interpolant = !m.dense.empty();
  const int local_order =
      has_own_interpolant ? (m.order == 5 ? 5 : 8) : std::min(m.order + 1, 4);
  const double h = m.order == 8 ? 0.4 : 0.05;
  EXPECT_NEAR(std::log2(error(h) / error(h / 2)), local_order, m.order == 8 ? 0.5 : 0.2);
  EXPECT_GT(error(h / 2), 10 * epsilon) << "round-off";
}

TEST_P(Methods, dense_output_meets_both_ends_of_the_step) {
  FunctionSystem system = swing();
  RungeKutta rk(method(), lenient());
  std::vector<double> y{1.7};
  (void)rk.attempt(system, 0.3, 0.4, y);
  rk.prepare_dense_output(system);
  double start = 0, end = 0;
  rk.dense_output(0, 0, {&start, 1});
  rk.dense_output(1, 0, {&end, 1});
  EXPECT_NEAR(start, 1.7, 8 * epsilon);
  EXPECT_NEAR(end, rk.end_state()[0], 8 * epsilon);
}

TEST_P(Methods, dense_output_of_a_part_is_that_part_of_the_whole) {
  FunctionSystem system([](double t, std::span<const double> y, std::span<double> rate) {
    for (std::size_t i = 0; i < y.size(); ++i)
      rate[i] = y[(i + 1) % y.size()] * std::cos(t + static_cast<double>(i));
  });
  RungeKutta rk(method(), lenient(5));
  std::vector<double> y{1, 2, 3, 4, 5}, whole(5), part(2);
  (void)rk.attempt(system, 0.3, 0.1, y);
  rk.prepare_dense_output(system);
  rk.dense_output(0.4, 0, whole);
  rk.dense_output(0.4, 2, part);
  EXPECT_EQ(part[0], whole[2]);
  EXPECT_EQ(part[1], whole[3]);
}

TEST_P(Methods, the_error_estimate_falls_with_the_power_it_claims) {
  const ButcherTableau& m = method();
  if (m.error_order == 0) {
    EXPECT_TRUE(m.error.empty());
    return;
  }
  FunctionSystem system([](double t, std::span<const double> y, std::span<double> rate) {
    rate[0] = y[1];
    rate[1] = -std::sin(3 * y[0]) * y[1] + std::cos(1.3 * t);
  });
  const auto estimate = [&](double h) {
    RungeKutta rk(m, {.rtol = 1, .column_scale = {1}});
    std::vector<double> y{0.7, 1.2};
    return rk.attempt(system, 0.3, h, y).error;
  };
  EXPECT_NEAR(std::log2(estimate(0.05) / estimate(0.025)), m.error_order, 0.3);
}

TEST_P(Methods, a_step_can_be_attempted_again_and_costs_one_evaluation_a_stage) {
  const ButcherTableau& m = method();
  FunctionSystem system = swing();
  RungeKutta rk(m, lenient());
  std::vector<double> y{1.7};
  (void)rk.attempt(system, 0.3, 0.4, y);
  (void)rk.attempt(system, 0.3, 0.1, y);
  const double again = rk.end_state()[0];
  EXPECT_EQ(y[0], 1.7);

  RungeKutta fresh(m, lenient());
  (void)fresh.attempt(system, 0.3, 0.1, y);
  EXPECT_EQ(again, fresh.end_state()[0]);

  fresh.commit(y);
  EXPECT_EQ(y[0], again);
  const long before = system.evaluations;
  constexpr int steps = 10;
  for (int i = 1; i <= steps; ++i) {
    (void)fresh.attempt(system, 0.3 + i * 0.1, 0.1, y);
    fresh.commit(y);
  }
  EXPECT_EQ(system.evaluations - before, steps * static_cast<long>(m.stages.size()));
}

TEST_P(Methods, looking_into_a_step_does_not_change_the_next_ones) {
  const auto end = [&](bool look) {
    FunctionSystem system = swing();
    RungeKutta rk(method(), lenient());
    std::vector<double> y{1.7};
    for (int i = 0; i < 20; ++i) {
      (void)rk.attempt(system, 0.125 * i, 0.125, y);
      if (look) rk.prepare_dense_output(system);
      rk.commit(y);
    }
    return y[0];
  };
  EXPECT_EQ(end(true), end(false));
}

TEST_P(Methods, after_a_restart_the_state_may_have_been_changed) {
  FunctionSystem system = swing();
  RungeKutta rk(method(), lenient()), fresh(method(), lenient());
  std::vector<double> y{1.7}, other{2.9};
  (void)rk.attempt(system, 0.3, 0.1, y);
  rk.commit(y);
  y = other;
  rk.restart();
  (void)rk.attempt(system, 0.4, 0.1, y);
  (void)fresh.attempt(system, 0.4, 0.1, other);
  EXPECT_EQ(rk.end_state()[0], fresh.end_state()[0]);
}

// Not a number from a given evaluation on, whichever stage that is.
TEST_P(Methods, a_nan_is_never_accepted) {
  const std::size_t stages = method().stages.size();
  for (std::size_t first = 0; first < stages; ++first) {
    for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      long calls = 0;
      FunctionSystem system([&](double, std::span<const double>, std::span<double> rate) {
        std::ranges::fill(rate, 1.0);
        if (calls++ >= static_cast<long>(first)) rate[3] = poison;
      });
      RungeKutta rk(method(), lenient(2));
      std::vector<double> y(6, 1.0);
      EXPECT_FALSE(rk.attempt(system, 0, 0.1, y).error <= 1) << first << " " << poison;
    }
  }
}

// Two squares of such an error underflow.
TEST_P(Methods, an_error_far_below_the_tolerance_is_accepted) {
  FunctionSystem system([](double t, std::span<const double>, std::span<double> rate) {
    rate[0] = 1e-180 * std::sin(100 * t);
  });
  RungeKutta rk(method(), {.rtol = 1e-6, .column_scale = {1}});
  std::vector<double> y{0};
  EXPECT_LE(rk.attempt(system, 0, 0.1, y).error, 1);
}

// Every stage is finite; their sum is not.
TEST_P(Methods, an_infinite_end_is_never_accepted) {
  FunctionSystem system([](double, std::span<const double>, std::span<double> rate) {
    std::ranges::fill(rate, 1e308);
  });
  RungeKutta rk(method(), lenient());
  std::vector<double> y{1e308};
  EXPECT_FALSE(rk.attempt(system, 0, 1, y).error <= 1);
}

TEST(RungeKutta, the_first_step_changes_nothing_by_more_than_a_hundredth_of_its_scale) {
  FunctionSystem system([](double, std::span<const double>, std::span<double> rate) {
    rate[0] = 30, rate[1] = -2;
  });
  RungeKutta rk(butcher_tableau("dormand-prince"),
                {.rtol = 1e-8, .column_scale = {5, 0.1}});
  std::vector<double> y{1, 0.3};
  const double h = rk.initial_step(system, 0, y);
  // 30/(5 + 1) = 2/(0.1 + 0.3) = 5 per second
  EXPECT_NEAR(h, 0.01 / 5, 1e-15);
  FunctionSystem rest([](double, std::span<const double>, std::span<double> rate) {
    std::ranges::fill(rate, 0.0);
  });
  rk.restart();
  EXPECT_EQ(rk.initial_step(rest, 0, y), 0);
}

TEST(RungeKutta, names_the_component_that_limits_the_step) {
  FunctionSystem system([](double t, std::span<const double>, std::span<double> rate) {
    std::ranges::fill(rate, std::sin(t));
    rate[4] = std::sin(10 * t);
  });
  RungeKutta rk(butcher_tableau("dormand-prince"), {.rtol = 1e-8, .column_scale = {1, 1}});
  std::vector<double> y(6, 0.0);
  (void)rk.attempt(system, 0, 0.1, y);
  EXPECT_EQ(rk.worst_component(), 4U);
}

TEST(ButcherTableau, an_unknown_method_is_wrong_input_that_lists_the_known_ones) {
  try {
    (void)butcher_tableau("rk5");
    FAIL();
  } catch (const InputError& e) {
    const std::string message = e.what();
    for (const ButcherTableau& t : butcher_tableaus())
      EXPECT_NE(message.find(t.name), std::string::npos) << message;
    EXPECT_NE(message.find("rk5"), std::string::npos) << message;
  }
}

} // namespace
} // namespace ehdjet
