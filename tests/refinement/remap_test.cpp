#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/remap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Values = std::vector<double>;

double sum(const Values& values) {
  CompensatedSum total;
  for (const double v : values) total += v;
  return total;
}

class Random {
public:
  /// Log-uniform over so many decades below 1.
  double wild(double decades) {
    return std::pow(10, -decades * real(bits_()) / 4294967295.0);
  }
  Values wild(std::size_t n, double decades) {
    Values v(n);
    for (double& x : v) x = wild(decades);
    return v;
  }
  /// Knots with such links from 0 to 1.
  Values cut(std::size_t links, double decades) {
    Values knots{0};
    for (std::size_t i = 0; i < links; ++i) knots.push_back(knots.back() + wild(decades));
    const double end = knots.back();
    for (double& k : knots) k /= end;
    return knots;
  }

private:
  std::mt19937 bits_{7};
};

TEST(Remap, keeps_every_sum_to_round_off) {
  Random random;
  for (const std::size_t links : {1U, 2U, 3U, 37U, 1000U}) {
    const Values q = random.wild(100, 6);
    const Remap remap(random.cut(100, 3), random.cut(links, 3));
    EXPECT_NEAR(sum(remap(q)) / sum(q), 1, 1e-14) << links;
  }
}

TEST(Remap, keeps_wildly_varying_positive_quantities_positive) {
  Random random;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Values q = random.wild(60, 8);
    const Values moved = Remap(random.cut(60, 2), random.cut(200, 2))(q);
    EXPECT_GT(std::ranges::min(moved), 0);
  }
}

// Sixteen decades: as a difference of cumulative sums the small quantities would be noise.
TEST(Remap, keeps_the_digits_of_small_quantities) {
  const Values from{0, 1, 2, 3, 4}, to{0, 0.5, 1, 2, 2.25, 3, 3.5, 4};
  const Values moved = Remap(from, to)(Values{1, 3e-20, 2, 7e-18});
  const Values expected{0.5, 0.5, 3e-20, 0.5, 1.5, 3.5e-18, 3.5e-18};
  ASSERT_EQ(moved.size(), expected.size());
  for (std::size_t j = 0; j < moved.size(); ++j)
    EXPECT_NEAR(moved[j] / expected[j], 1, 2 * epsilon) << j;
}

TEST(Remap, gives_each_new_link_its_overlap_with_the_old_ones) {
  const Values from{1, 2, 4, 5}, to{1, 1.25, 3, 4.5, 5};
  const Values moved = Remap(from, to)(Values{4, 6, 10});
  EXPECT_EQ(moved, (Values{1, 3 + 3, 3 + 5, 5}));
}

TEST(Remap, averages_densities) {
  Random random;
  const Values from = random.cut(60, 2), to = random.cut(150, 2), q = random.wild(60, 8);
  const Values moved = Remap(from, to)(q);
  std::size_t i = 0;
  for (std::size_t j = 0; j < moved.size(); ++j) {
    double low = 1e300, high = 0;
    for (std::size_t k = 0; k < q.size(); ++k)
      if (from[k] < to[j + 1] && from[k + 1] > to[j]) {
        const double density = q[k] / (from[k + 1] - from[k]);
        low = std::min(low, density), high = std::max(high, density), ++i;
      }
    const double density = moved[j] / (to[j + 1] - to[j]);
    // Short new links are differences of places of order 1.
    const double round_off = 2 * epsilon / (to[j + 1] - to[j]);
    EXPECT_GE(density, low * (1 - round_off)) << j;
    EXPECT_LE(density, high * (1 + round_off)) << j;
  }
  EXPECT_GE(i, moved.size());
}

TEST(Remap, the_same_cut_changes_nothing) {
  Random random;
  const Values knots = random.cut(50, 2), q = random.wild(50, 2);
  EXPECT_EQ(Remap(knots, knots)(q), q);
}

TEST(Remap, a_constant_density_stays_constant) {
  Random random;
  const Values from = random.cut(50, 1), to = random.cut(80, 1);
  Values q;
  for (std::size_t i = 1; i < from.size(); ++i) q.push_back(3 * (from[i] - from[i - 1]));
  {
    const Values moved = Remap(from, to)(q);
    for (std::size_t j = 0; j < moved.size(); ++j)
      EXPECT_NEAR(moved[j], 3 * (to[j + 1] - to[j]), 16 * epsilon) << j;
  }
}

TEST(Remap, both_cuts_must_be_of_one_stretch) {
  EXPECT_THROW(Remap({0, 1, 2}, {0, 1.5}), ContractViolation);
  EXPECT_THROW(Remap({0, 1, 2}, {0.5, 2}), ContractViolation);
  EXPECT_THROW(Remap({0}, {0}), ContractViolation);
  EXPECT_THROW((void)Remap({0, 1}, {0, 1})(Values{1, 2}), ContractViolation);
}

} // namespace
} // namespace ehdjet
