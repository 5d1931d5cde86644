#include "ehdjet/sweeps/time_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace ehdjet {
namespace {

/// x_i = phi x_{i-1} + noise, stationary from the start, of mean 3.
std::vector<double> autoregressive(double phi, std::size_t n, std::mt19937_64& random) {
  std::normal_distribution<double> noise;
  std::vector<double> x(n);
  double deviation = noise(random) / std::sqrt(1 - phi * phi);
  for (double& value : x) {
    value = 3 + deviation;
    deviation = phi * deviation + noise(random);
  }
  return x;
}

// The scatter of the means of many series is the standard error, whatever the formula.
TEST(TimeMean, its_error_is_the_scatter_of_the_means_of_many_series) {
  std::mt19937_64 random(
      7); // NOLINT(cert-msc32-c,cert-msc51-cpp): the same series every time
  for (const double phi : {0.0, 0.5, 0.9, 0.97}) {
    constexpr std::size_t series = 400, n = 5000;
    double squares = 0, claimed = 0;
    for (std::size_t s = 0; s < series; ++s) {
      const TimeMean mean = time_mean(autoregressive(phi, n, random));
      squares += (mean.mean - 3) * (mean.mean - 3), claimed += *mean.standard_error;
    }
    const double scatter = std::sqrt(squares / series);
    EXPECT_NEAR(claimed / series / scatter, 1, 0.12) << "phi = " << phi;
  }
}

TEST(TimeMean, a_constant_has_no_error_and_a_short_series_has_none_to_tell) {
  EXPECT_EQ(time_mean(std::vector<double>(20, 5.0)).mean, 5);
  EXPECT_EQ(time_mean(std::vector<double>(20, 5.0)).standard_error, 0);
  EXPECT_EQ(time_mean(std::vector<double>{1, 2, 6}).mean, 3);
  EXPECT_FALSE(time_mean(std::vector<double>{1, 2, 6}).standard_error);
}

TEST(TimeMean, a_wave_gains_nothing_over_independent_values) {
  std::vector<double> wave(1000);
  for (std::size_t i = 0; i < wave.size(); ++i)
    wave[i] = std::sin(2.5 * static_cast<double>(i));
  EXPECT_NEAR(*time_mean(wave).standard_error, std::sqrt(0.5 / 1000), 2e-4);
}

} // namespace
} // namespace ehdjet
