#include "ehdjet/core/error.hpp"
#include "ehdjet/events/root.hpp"

#include <gsl/gsl_errno.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace ehdjet {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(FirstCrossing, is_the_root_to_round_off_and_never_before_it) {
  for (const double root : {1e-9, 0.013, 0.37, 0.5, 0.999999, 1.0}) {
    const auto linear = [root](double s) { return 3.7 * (s - root); };
    const auto bent = [root](double s) { return std::expm1(5 * (s - root)) + (s - root); };
    const auto flat = [root](double s) { return std::pow(s - root, 3); };
    for (const auto& [theta, tolerance] : {std::pair{first_crossing(linear), 4 * epsilon},
                                           {first_crossing(bent), 4 * epsilon},
                                           {first_crossing(flat), 1e-5}}) {
      ASSERT_TRUE(theta) << root;
      EXPECT_NEAR(*theta, root, tolerance) << root;
      EXPECT_LE(*theta, 1);
    }
    EXPECT_GE(linear(*first_crossing(linear)), 0) << root;
    EXPECT_GE(bent(*first_crossing(bent)), 0) << root;
  }
}

TEST(FirstCrossing, is_none_if_the_step_ends_below) {
  EXPECT_FALSE(first_crossing([](double s) { return s - 1.0001; }));
}

bool own_handler_called = false;
void own_handler(const char*, const char*, int, int) {
  own_handler_called = true;
}

// A library does not end the program that uses it, and leaves the program's handler of GSL's errors
// alone.
TEST(FirstCrossing,
     that_is_not_a_number_is_an_error_and_none_for_the_handler_of_the_program) {
  gsl_error_handler_t* const before = gsl_set_error_handler(own_handler);
  const auto not_a_number_at = [](double place) {
    return [place](double s) { return std::abs(s - place) < 0.1 ? std::nan("") : s - 0.5; };
  };
  for (const double place : {0.0, 1.0, 0.5}) {
    try {
      (void)first_crossing(not_a_number_at(place));
      ADD_FAILURE() << place;
    } catch (const RunError& e) {
      EXPECT_NE(std::string(e.what()).find("not a number"), std::string::npos);
    }
  }
  struct Own {};
  EXPECT_THROW((void)first_crossing([](double s) {
                 if (s > 0 && s < 1) throw Own();
                 return s - 0.5;
               }),
               Own);
  EXPECT_FALSE(own_handler_called);
  EXPECT_EQ(gsl_set_error_handler(before), own_handler);
}

TEST(FirstCrossing, is_the_start_if_that_is_not_below) {
  EXPECT_EQ(first_crossing([](double s) { return s; }), 0.0);
  EXPECT_EQ(first_crossing([](double s) { return s + 1; }), 0.0);
}

TEST(FirstCrossing, needs_few_looks_into_a_smooth_step) {
  int looks = 0;
  (void)first_crossing([&](double s) {
    ++looks;
    return std::expm1(2 * (s - 0.37));
  });
  EXPECT_LE(looks, 40);
}

TEST(ExpectedCrossing, is_exact_for_a_parabola) {
  for (const double root : {1.01, 1.7, 12.0}) {
    const auto parabola = [root](double s) { return (s - root) * (s + 5); };
    const auto theta = expected_crossing(parabola(0), parabola(1), (1 - root) + (1 + 5));
    if (root < 6) { // still rising at the end of the step
      ASSERT_TRUE(theta) << root;
      EXPECT_NEAR(*theta, root, 1e-13) << root;
    }
  }
  EXPECT_NEAR(*expected_crossing(-4, -3, 1), 4, 1e-14); // a straight line
}

TEST(ExpectedCrossing, is_none_for_what_recedes_or_is_past) {
  EXPECT_FALSE(expected_crossing(-1, -2, -1));
  EXPECT_FALSE(expected_crossing(-2, -1, 0.1)); // a parabola that turns before zero
  EXPECT_FALSE(expected_crossing(-1, 1, 2));
  EXPECT_FALSE(expected_crossing(std::nan(""), -1, 1));
}

} // namespace
} // namespace ehdjet
