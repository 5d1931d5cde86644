#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/step_size_control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace ehdjet {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two columns of three components, as metres and pascals might be.
const ErrorScale scale{.rtol = 1e-3, .column_scale = {2e-4, 500}};
const std::vector<double> y0{1e-4, -3e-4, 0, 100, -2000, 0}, y1{2e-4, 1e-4, 0, -300, 0, 50};

TEST(ErrorScale, each_column_is_measured_by_its_own_scale_and_the_larger_end) {
  const double allowed[] = {4e-4, 5e-4, 2e-4, 800, 2500, 550}; // scale + max(|y0|, |y1|)
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<double> error(6, 0.0);
    error[i] = -0.7e-3 * allowed[i];
    EXPECT_NEAR(scale.norm(error, y0, y1), 0.7, 1e-14) << i;
    EXPECT_EQ(scale.worst(error, y0, y1), i);
  }
}

TEST(ErrorScale, the_norm_is_the_largest_component_or_the_root_mean_square) {
  const std::vector<double> error{0.3e-3 * 4e-4, 0, 0.6e-3 * 2e-4, 0, -0.9e-3 * 2500, 0};
  EXPECT_NEAR(scale.norm(error, y0, y1), 0.9, 1e-14);
  ErrorScale rms = scale;
  rms.root_mean_square = true;
  EXPECT_NEAR(rms.norm(error, y0, y1), std::sqrt((0.09 + 0.36 + 0.81) / 6), 1e-14);
}

TEST(ErrorScale, no_norm_accepts_a_nan_wherever_it_stands) {
  for (const bool root_mean_square : {false, true}) {
    ErrorScale s = scale;
    s.root_mean_square = root_mean_square;
    for (std::size_t i = 0; i < 6; ++i) {
      std::vector<double> error(6, 0.0), state = y1;
      error[i] = nan;
      EXPECT_FALSE(s.norm(error, y0, y1) <= 1) << i;
      EXPECT_EQ(s.worst(error, y0, y1), i);
      error[i] = infinity;
      EXPECT_FALSE(s.norm(error, y0, y1) <= 1) << i;
      EXPECT_EQ(s.worst(error, y0, y1), i);
      error[i] = 1e-9, state[i] = nan;
      EXPECT_FALSE(s.norm(error, y0, state) <= 1) << "in the state " << i;
    }
  }
}

// Of a long vector all threads look at a part; the parts know nothing of where columns end.
TEST(ErrorScale, rows_behind_the_judged_ones_do_not_count_in_a_long_vector) {
  const std::size_t rows = parallel_from + 77, judged = rows - 5000;
  std::vector<double> error(2 * rows), y(2 * rows), short_error, short_y;
  for (std::size_t i = 0; i < 2 * rows; ++i) {
    const bool counts = i % rows < judged;
    y[i] = counts ? std::cos(0.1 * static_cast<double>(i)) : nan;
    error[i] = counts ? 1e-3 * std::sin(static_cast<double>(i)) : infinity;
    if (counts) short_error.push_back(error[i]), short_y.push_back(y[i]);
  }
  for (const bool root_mean_square : {false, true}) {
    ErrorScale s = scale;
    s.root_mean_square = root_mean_square;
    const double whole = s.norm(short_error, short_y, short_y);
    EXPECT_NEAR(s.norm(error, y, y, judged) / whole, 1, 1e-13) << root_mean_square;
    const double alone = [&] {
      const ThreadCount count(1);
      return s.norm(error, y, y, judged);
    }();
    for (const std::size_t threads : {2U, 3U}) {
      const ThreadCount count(threads);
      EXPECT_EQ(s.norm(error, y, y, judged), alone) << threads;
    }
  }
}

TEST(ErrorScale, columns_that_do_not_divide_the_vector_are_a_contract_violation) {
  const std::vector<double> five(5, 0.0);
  EXPECT_THROW((void)scale.norm(five, five, five), ContractViolation);
}

TEST(StepSizeControl, aims_below_the_tolerance_with_the_order_of_the_estimate) {
  StepSizeControl control(5);
  // h_new/h = 0.9 err^-(1/q - 0.75 beta) err_old^beta, err_old = 1e-4 at the start, beta = 0.04
  const double first = 0.9 * std::pow(0.3, -(0.2 - 0.03)) * std::pow(1e-4, 0.04);
  EXPECT_NEAR(control.after_accepted(2.0, 0.3) / 2, first, 1e-14);
  const double second = 0.9 * std::pow(0.8, -(0.2 - 0.03)) * std::pow(0.3, 0.04);
  EXPECT_NEAR(control.after_accepted(2.0, 0.8) / 2, second, 1e-14);
}

TEST(StepSizeControl, changes_a_step_at_most_fivefold) {
  StepSizeControl control(5);
  EXPECT_EQ(control.after_accepted(2.0, 0.0), 10.0);
  EXPECT_NEAR(control.after_rejected(2.0, 1e12), 0.4, 1e-15);
  EXPECT_NEAR(control.after_rejected(2.0, nan), 0.4, 1e-15);
  EXPECT_NEAR(control.after_rejected(2.0, infinity), 0.4, 1e-15);
}

TEST(StepSizeControl, a_rejected_step_shrinks_and_its_successor_does_not_grow) {
  StepSizeControl control(5);
  EXPECT_NEAR(control.after_rejected(2.0, 3.0), 2 * 0.9 * std::pow(3.0, -0.2), 1e-14);
  EXPECT_LT(control.after_rejected(2.0, 1.0000001), 2.0);
  EXPECT_LE(control.after_accepted(1.0, 1e-8), 1.0);
  EXPECT_GT(control.after_accepted(1.0, 1e-8), 1.0);
}

} // namespace
} // namespace ehdjet
