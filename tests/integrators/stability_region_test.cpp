#include "ehdjet/integrators/stability_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <vector>

namespace ehdjet {
namespace {

// Taylor's polynomial to the order of the method, which is all of R where s stages give order s.
TEST(StabilityRegion, amplification_is_the_known_polynomial) {
  struct Row {
    const char* method;
    std::vector<double> coefficients;
  };
  for (const auto& [method, coefficients] :
       {Row{"euler", {1, 1}}, Row{"heun", {1, 1, 1. / 2}},
        Row{"rk4", {1, 1, 1. / 2, 1. / 6, 1. / 24}},
        Row{"dormand-prince", {1, 1, 1. / 2, 1. / 6, 1. / 24, 1. / 120, 1. / 600}}})
    for (const std::complex<double> z :
         {std::complex<double>(-1.7, 0.4), {0, 2}, {-3, 0}}) {
      std::complex<double> sum = 0, power = 1;
      for (const double c : coefficients) sum += c * power, power *= z;
      EXPECT_LE(std::abs(amplification(butcher_tableau(method), z) - sum), 1e-13) << method;
    }
}

TEST(StabilityRegion, ends_at_the_known_limits) {
  const auto limit = [](const char* method, std::complex<double> s) {
    return longest_stable_step(butcher_tableau(method), s);
  };
  EXPECT_NEAR(limit("euler", -1), 2, 1e-9);
  EXPECT_NEAR(limit("heun", -4), 2. / 4, 1e-9);
  // 2 sqrt(2) on the imaginary axis; on the real one the root of 24 + 12 x + 4 x^2 + x^3.
  EXPECT_NEAR(limit("rk4", {0, 1}), 2 * std::sqrt(2), 1e-6);
  EXPECT_NEAR(limit("rk4", -1), 2.785293563405, 1e-9);
  EXPECT_NEAR(limit("rk4", {0, -50}), 2 * std::sqrt(2) / 50, 1e-7);
  EXPECT_NEAR(limit("dormand-prince", -1), 3.3066, 1e-4);
  const double diagonal = limit("rk4", {-1, 1}) * std::sqrt(2);
  EXPECT_GT(diagonal, 2.5);
  EXPECT_LT(diagonal, 3.5);
  EXPECT_EQ(limit("rk4", 0), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace ehdjet
