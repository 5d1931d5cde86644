#include <limits>

#include "coulomb/all_solvers.hpp"
#include "coulomb/reference.hpp"

namespace ehdjet::test {
namespace {

class ExtremeRatios : public SolverTest {};

// In any global norm the small charges and wide gaps would not be seen: each bead on its own.
TEST_P(ExtremeRatios, twenty_decades_of_charge_and_six_of_spacing_are_right_per_bead) {
  const Chain chain = random_chain(400, 20, 6);
  EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance());
}

// Distances between 1e-30 and 1e30 of each other, all from the origin outwards, where
// coordinates that small still differ. Some pairs are too close for single precision.
TEST_P(ExtremeRatios, sixty_decades_of_distance_are_right_per_bead) {
  Chain chain;
  for (int k = 0; k <= 240; ++k)
    chain.add(std::pow(10, -30 + k / 4.0) * (k % 3 == 0 ? across : along), 1 + k % 5);
  EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance());
}

// One close pair among ordinary ones: at 1e-40 and at the smallest distance there is.
TEST_P(ExtremeRatios, beads_that_almost_coincide_repel_as_coulomb_says) {
  for (const double distance : {1e-17, 1e-20, 1e-36, 1e-40, 1e-100}) {
    Chain chain = random_chain(30, 1, 1);
    for (const std::size_t i : {3U, 17U, 18U})
      chain.set(i, distance * static_cast<double>(i) * across);
    EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance()) << distance;
    EXPECT_EQ(solver->coincident_pairs(), 0U);
  }
}

// From ordinary to close in small steps along each axis: no pair is summed twice or lost where
// one way of summing takes over from the other.
TEST_P(ExtremeRatios, no_pair_is_lost_between_near_and_too_near) {
  for (int step = 0; step < 120; ++step) {
    Chain chain = random_chain(21, 1, 0, static_cast<unsigned>(step));
    for (const std::size_t i : {2U, 3U, 20U}) {
      Vec3 r = Vec3::Zero();
      r[step % 3] = std::pow(10, -31 - step / 20.0) * static_cast<double>(i);
      chain.set(i, r);
    }
    EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance()) << step;
  }
}

// q_i q_j is below the smallest double, the force of neighbours 1e-150 m apart is not.
TEST_P(ExtremeRatios, charges_whose_product_underflows_still_repel) {
  Chain chain = random_chain(50, 2, 1);
  for (double& q : chain.q) q *= 1e-160;
  for (auto* column : {&chain.x, &chain.y, &chain.z})
    for (double& v : *column) v *= 1e-150;
  EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance());
}

TEST_P(ExtremeRatios, coordinates_whose_square_overflows_give_a_finite_force) {
  for (const double size : {1e150, 1e160, 1e300}) {
    Chain chain = random_chain(50, 2, 1);
    for (double& q : chain.q) q *= 1e140;
    for (auto* column : {&chain.x, &chain.y, &chain.z})
      for (double& v : *column) v *= size;
    const Force force = force_on(chain, *solver);
    if (size < 1e200) {
      EXPECT_LE(worst_error(chain, force), tolerance()) << size;
    } else { // the force itself is below the smallest double
      for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_LE(force[i].norm(), 1e-300);
    }
  }
}

TEST_P(ExtremeRatios, subnormal_coordinates_and_charges_give_no_nan) {
  Chain chain = random_chain(20, 0, 0);
  for (auto* column : {&chain.x, &chain.y, &chain.z, &chain.q})
    for (double& v : *column) v *= 1e-310;
  const Force force = force_on(chain, *solver);
  for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_FALSE(force[i].hasNaN()) << i;
}

TEST_P(ExtremeRatios, beads_without_charge_feel_and_exert_nothing) {
  Chain chain = random_chain(20, 0, 0);
  for (const double charge : {0.0, 1.0}) {
    chain.q.assign(20, 0.0);
    chain.q[0] = charge;
    chain.set(1, chain.r()[0] + Vec3(0, 0, 1e-320)); // where q/r would be infinite
    const Force force = force_on(chain, *solver);
    for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_EQ(force[i].norm(), 0.0) << i;
  }
}

// Three beads on one point are three pairs; two on another, in other tiles, a fourth.
TEST_P(ExtremeRatios, coincident_beads_are_counted_and_exert_nothing_on_each_other) {
  for (const std::size_t n : {20U, 150U, 1123U}) {
    Chain chain = random_chain(n, 1, 1);
    chain.set(5, chain.r()[2]), chain.set(n - 1, chain.r()[2]);
    chain.set(9, chain.r()[8]);
    EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance()) << n;
    EXPECT_EQ(solver->coincident_pairs(), 4U) << n;
  }
}

TEST_P(ExtremeRatios, a_chain_on_a_single_point_is_all_coincident_pairs) {
  for (const Vec3& point : {Vec3(Vec3::Zero()), Vec3(0.1 * along)}) {
    Chain chain(21);
    for (std::size_t i = 0; i < 21; ++i) chain.set(i, point);
    const Force force = force_on(chain, *solver);
    for (std::size_t i = 0; i < 21; ++i) EXPECT_EQ(force[i].norm(), 0.0) << i;
    EXPECT_EQ(solver->coincident_pairs(), 210U);
  }
  force_on(straight_chain(21), *solver);
  EXPECT_EQ(solver->coincident_pairs(), 0U) << "the count is of the last call";
}

TEST_P(ExtremeRatios, collinear_beads_stay_on_their_line) {
  Chain chain(333);
  for (std::size_t i = 0; i < 333; ++i) chain.x[i] = std::pow(static_cast<double>(i), 1.5);
  const Force force = force_on(chain, *solver);
  EXPECT_LE(worst_error(chain, force), tolerance());
  for (std::size_t i = 0; i < 333; ++i) EXPECT_EQ(force[i].tail<2>().norm(), 0.0) << i;
}

// Far from the origin nothing but the positions' own rounding is lost.
TEST_P(ExtremeRatios, a_chain_far_from_the_origin_is_as_exact) {
  Chain chain = random_chain(150, 1, 1);
  for (double& v : chain.y) v += 1e6;
  EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance());
}

EHDJET_FOR_ALL_SOLVERS(ExtremeRatios);

} // namespace
} // namespace ehdjet::test
