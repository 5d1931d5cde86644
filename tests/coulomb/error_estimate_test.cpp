#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "coulomb/reference.hpp"

namespace ehdjet::test {
namespace {

CoulombErrorSample error_of(const Chain& chain, Force force, std::size_t max_targets) {
  return sampled_error({chain.r(), chain.q}, force.view(), ToleranceNorm::global,
                       max_targets);
}

TEST(SampledError, a_known_error_is_found_in_both_norms) {
  const Chain chain = random_chain(100, 1, 1);
  Force force = force_on(chain, *make_direct_sum());
  double total = 0;
  for (std::size_t i = 0; i < 100; ++i) total += force[i].squaredNorm();
  const Vec3 wrong = 1e-3 * std::sqrt(total) * along;
  force.view().add(17, wrong);

  const CoulombErrorSample sample = error_of(chain, force, 100);
  const double pair_sum = static_cast<double>(ReferenceForce(chain, 17).pair_sum);
  EXPECT_EQ(sample.targets, 100U);
  EXPECT_NEAR(sample.relative_l2, 1e-3, 1e-12); // round-off, of sums that cancel a little
  EXPECT_NEAR(sample.worst_per_target, wrong.norm() / pair_sum, 1e-12);
  const double net = (force[17] - wrong).norm();
  EXPECT_NEAR(sample.worst_of_net, wrong.norm() / net, 1e-12 * wrong.norm() / net);
  EXPECT_LT(sample.median_of_net, 1e-12); // all others are right
}

TEST(SampledError, targets_are_spread_evenly_over_the_chain) {
  const Chain chain = straight_chain(205);
  const Force exact = force_on(chain, *make_direct_sum());
  std::size_t seen = 0;
  for (std::size_t i = 0; i < 205; ++i) {
    Force force = exact;
    force.x[i] += 1e12;
    const CoulombErrorSample sample = error_of(chain, force, 10);
    EXPECT_EQ(sample.targets, 10U);
    if (sample.relative_l2 > 1e-3) {
      EXPECT_EQ(i, seen * 205 / 10);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 10U);
}

TEST(SampledError, of_the_charges_that_move_leaves_the_others_and_the_strongest_out) {
  Chain chain = random_chain(100, 0, 0);
  chain.q[7] = 1e3; // has nearly all of |F|^2
  const std::vector<std::uint8_t> moves = [] {
    std::vector<std::uint8_t> m(100, 1);
    for (std::size_t i = 60; i < 100; ++i) m[i] = 0;
    return m;
  }();
  Force force = force_on(chain, *make_direct_sum());
  std::vector<double> squares;
  for (std::size_t i = 0; i < 60; ++i) squares.push_back(force[i].squaredNorm());
  std::ranges::sort(squares);
  const double mean = std::accumulate(squares.begin(), squares.begin() + 54, 0.0) / 54;
  force.view().add(80, 1e9 * along); // rests
  const Vec3 wrong = 1e-3 * std::sqrt(60 * mean) * along;
  force.view().add(30, wrong);
  const CoulombErrorSample sample =
      sampled_error({chain.r(), chain.q, moves}, force.view(), ToleranceNorm::moving);
  EXPECT_EQ(sample.targets, 60U);
  EXPECT_NEAR(sample.in(ToleranceNorm::moving), 1e-3, 1e-9);
  EXPECT_LT(sample.in(ToleranceNorm::global), 0.5e-3);
}

TEST(SampledError, a_nan_is_not_lost) {
  const Chain chain = straight_chain(30);
  Force force = force_on(chain, *make_direct_sum());
  force.y[4] = std::nan("");
  const CoulombErrorSample sample = error_of(chain, force, 2000);
  EXPECT_TRUE(std::isnan(sample.relative_l2));
  EXPECT_TRUE(std::isnan(sample.worst_per_target));
}

TEST(SampledError, nothing_wrong_with_nothing_is_zero) {
  const Chain alone(1), nobody(0);
  EXPECT_EQ(error_of(alone, Force(1), 2000).relative_l2, 0);
  EXPECT_EQ(error_of(alone, Force(1), 2000).worst_per_target, 0);
  EXPECT_EQ(error_of(nobody, Force(0), 2000).targets, 0U);
  EXPECT_THROW(error_of(alone, Force(1), 0), ContractViolation);
  EXPECT_THROW(error_of(alone, Force(2), 1), ContractViolation);
}

} // namespace
} // namespace ehdjet::test
