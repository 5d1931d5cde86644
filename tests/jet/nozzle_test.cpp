#include "ehdjet/jet/nozzle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace ehdjet {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

const Nozzle nozzle{
    .fluid_velocity = 2.8e-3, .amplitude = 1e-5, .angular_frequency = 1e4, .phase = 0.3};

// Integrated with explicit Euler at 1e-6 s the radius would have grown 22,000-fold by then.
TEST(Nozzle, stays_on_its_circle_at_any_time) {
  for (const double t : {0.0, 1e-3, 0.0517, 0.2}) {
    const Vec3 r = nozzle.position(t), v = nozzle.velocity(t);
    EXPECT_EQ(r.x(), 0);
    EXPECT_NEAR(r.norm() / nozzle.amplitude, 1, 4 * epsilon) << t;
    EXPECT_NEAR(std::hypot(v.y(), v.z()) / 0.1, 1, 4 * epsilon) << t; // omega A
    EXPECT_EQ(v.x(), nozzle.fluid_velocity);
    EXPECT_NEAR(r.y() * v.y() + r.z() * v.z(), 0, 4 * epsilon * 1e-6) << t;
  }
}

TEST(Nozzle, turns_from_y_to_z_starting_at_its_phase) {
  for (const double t : {0.0, 1e-3, 0.0517, 0.2}) {
    const double angle = 1e4 * t + 0.3;
    const Vec3 r = nozzle.position(t);
    // The product omega t is rounded: epsilon times 2000 rad.
    EXPECT_NEAR(r.y(), 1e-5 * std::cos(angle), 2 * angle * epsilon * 1e-5) << t;
    EXPECT_NEAR(r.z(), 1e-5 * std::sin(angle), 2 * angle * epsilon * 1e-5) << t;
  }
}

TEST(Nozzle, its_velocity_is_the_derivative_of_its_position) {
  const double t = 0.0123,
               h = 1e-8; // a phase of 1e-4: truncation 1e-4^2/6, round-off 1e-12
  const Vec3 slope = (nozzle.position(t + h) - nozzle.position(t - h)) / (2 * h);
  EXPECT_NEAR(slope.y(), nozzle.velocity(t).y(), 1e-8 * 0.1);
  EXPECT_NEAR(slope.z(), nozzle.velocity(t).z(), 1e-8 * 0.1);
}

TEST(Embryo, lies_on_the_segment_one_link_from_the_nozzle) {
  const Embryo embryo{.link_length = 2e-4};
  const Vec3 from(0, 7e-6, -6e-6), direction(1. / 3, 2. / 3, -2. / 3);
  for (const double d : {3e-4, 3.7e-4, 4e-4}) {
    const Vec3 r = embryo.position(from, from + d * direction);
    EXPECT_LE((r - from - 2e-4 * direction).norm(), 8 * epsilon * 2e-4) << d;
  }
}

TEST(Embryo, its_charge_grows_as_half_a_cosine_from_creation_to_release) {
  const Embryo embryo{.link_length = 2e-4};
  EXPECT_DOUBLE_EQ(embryo.creation_distance(), 3e-4);
  EXPECT_DOUBLE_EQ(embryo.release_distance(), 4e-4);
  EXPECT_EQ(embryo.charge_fraction(2.9e-4), 0);
  EXPECT_EQ(embryo.charge_fraction(embryo.creation_distance()), 0);
  EXPECT_NEAR(embryo.charge_fraction(3.25e-4), (1 - std::numbers::sqrt2 / 2) / 2, 1e-14);
  EXPECT_NEAR(embryo.charge_fraction(3.5e-4), 0.5, 1e-14);
  EXPECT_NEAR(embryo.charge_fraction(3.75e-4), (1 + std::numbers::sqrt2 / 2) / 2, 1e-14);
  EXPECT_EQ(embryo.charge_fraction(embryo.release_distance()), 1);
  EXPECT_EQ(embryo.charge_fraction(5e-4), 1);
  constexpr double h = 1e-9;
  for (const double d : {2.9e-4, 3.1e-4, 3.5e-4, 3.83e-4, 4.1e-4})
    EXPECT_NEAR(embryo.charge_fraction_slope(d),
                (embryo.charge_fraction(d + h) - embryo.charge_fraction(d - h)) / (2 * h),
                1e-6 / 1e-4)
        << d;
}

} // namespace
} // namespace ehdjet
