#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/akima_spline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Values = std::vector<double>;

Values spline(const Values& knots, const Values& values, const Values& at) {
  Values out(at.size());
  AkimaSpline(knots).interpolate(values, at, out);
  return out;
}

/// So many points in each interval, the knots among them.
Values within(const Values& knots, std::size_t per_interval) {
  Values at;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (std::size_t m = 0; m < per_interval; ++m)
      at.push_back(knots[i] + (knots[i + 1] - knots[i]) * (real(m) / real(per_interval)));
  at.push_back(knots.back());
  return at;
}

Values uniform(std::size_t n, double step = 1) {
  Values x;
  for (std::size_t i = 0; i < n; ++i) x.push_back(step * real(i));
  return x;
}

double worst_error(const Values& knots, const std::function<double(double)>& f) {
  const Values at = within(knots, 1000);
  Values values;
  for (const double x : knots) values.push_back(f(x));
  const Values got = spline(knots, values, at);
  double worst = 0;
  for (std::size_t i = 0; i < at.size(); ++i)
    worst = std::max(worst, std::abs(got[i] - f(at[i])));
  return worst;
}

TEST(AkimaSpline, runs_through_akimas_own_data_as_his_does) {
  const Values x{0, 2, 3, 5, 6, 8, 9, 11, 12, 14, 15};
  const Values y{10, 10, 10, 10, 10, 10, 10.5, 15, 50, 60, 85};
  const Values at{1, 7, 8.5, 9.5, 10, 10.5, 11.5, 12.5, 13, 13.5, 14.5};
  const Values expected{10,
                        10,
                        387. / 38,
                        1694271. / 154432,
                        28637. / 2413,
                        13.2057151367592,
                        1659275. / 53594,
                        54.5740521327014,
                        11572. / 211,
                        55.1913507109005,
                        281. / 4};
  const Values got = spline(x, y, at);
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_NEAR(got[i], expected[i], 1e-13) << at[i];
  EXPECT_EQ(spline(x, y, x), y);
}

// Akima's manual example in MSC Adams: AKIMA_SPLINE({1,2,3,4},{0,2,1,3},10).
TEST(AkimaSpline, continues_four_knots_as_akima_does) {
  const Values expected{0, 1, 5. / 3, 2, 16. / 9, 11. / 9, 1, 4. / 3, 2, 3};
  Values at;
  for (std::size_t i = 0; i < expected.size(); ++i) at.push_back(1 + real(i) / 3);
  const Values got = spline({1, 2, 3, 4}, {0, 2, 1, 3}, at);
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_NEAR(got[i], expected[i], 16 * epsilon) << at[i];
}

// Where both weights of a slope vanish there is a corner, as in GSL: straight lines throughout.
TEST(AkimaSpline, keeps_corners_between_straight_stretches) {
  const Values y{0, 0, 0, 1, 2, 2, 2};
  for (const auto& [x, expected] : {std::pair{0.5, 0.0},
                                    {1.5, 0.0},
                                    {2.25, 0.25},
                                    {2.5, 0.5},
                                    {3.5, 1.5},
                                    {3.75, 1.75},
                                    {4.5, 2.0},
                                    {5.5, 2.0}})
    EXPECT_EQ(spline(uniform(7), y, {x})[0], expected) << x;
}

TEST(AkimaSpline, is_a_parabola_through_three_uniform_knots) {
  const auto f = [](double x) { return 2 - 3 * x + 1.5 * x * x; };
  EXPECT_LE(worst_error({0, 2, 4}, f), 14 * 4 * epsilon);
}

TEST(AkimaSpline, is_a_line_through_two_knots) {
  const auto f = [](double x) { return 2 - 3 * x; };
  EXPECT_LE(worst_error({1, 1.7}, f), 4 * epsilon);
}

TEST(AkimaSpline, needs_two_ascending_knots) {
  EXPECT_THROW(AkimaSpline(Values{1}), ContractViolation);
  EXPECT_THROW(AkimaSpline(Values{}), ContractViolation);
  EXPECT_THROW(AkimaSpline(Values{0, 1, 1, 2}), ContractViolation);
  EXPECT_THROW(AkimaSpline(Values{0, 1, 0.5, 2, 3, 4}), ContractViolation);
}

// One object serves all columns of a jet.
TEST(AkimaSpline, does_not_remember_the_column_before) {
  for (const std::size_t knots : {2U, 3U, 4U, 5U, 9U}) {
    const Values x = uniform(knots), at = within(x, 7);
    Values y, other;
    for (const double k : x)
      y.push_back(std::sin(k)), other.push_back(100 * std::cos(3 * k));
    AkimaSpline reused(x);
    Values got(at.size());
    reused.interpolate(other, at, got);
    reused.interpolate(y, at, got);
    EXPECT_EQ(got, spline(x, y, at)) << knots;
  }
}

TEST(AkimaSpline, reproduces_lines_on_any_mesh) {
  const auto f = [](double x) { return 1 - 2.5 * x; };
  EXPECT_LE(worst_error({0, 1, 1.3, 2.5, 3, 4.2, 5, 6.5, 7}, f), 20 * epsilon);
  Values wild;
  for (double x = 1e-3; x < 7; x *= 1.9) wild.push_back(x);
  EXPECT_LE(worst_error(wild, f), 20 * epsilon);
}

// An interpolation "exact for quadratics" on any mesh is not Akima's.
TEST(AkimaSpline, reproduces_parabolas_on_uniform_meshes_only) {
  const auto square = [](double x) { return x * x; };
  EXPECT_LE(worst_error(uniform(9, 0.125), square), 7e-15);
  // Largest among 101 equidistant points; it is the one at 5.81.
  const Values x{0, 1, 1.3, 2.5, 3, 4.2, 5, 6.5, 7};
  Values y, at;
  for (std::size_t i = 0; i <= 100; ++i) at.push_back(7 * real(i) / 100);
  for (const double k : x) y.push_back(square(k));
  Values error = spline(x, y, at);
  for (std::size_t i = 0; i < at.size(); ++i) error[i] = std::abs(error[i] - square(at[i]));
  EXPECT_NEAR(std::ranges::max(error), 0.14655311162790952, 2e-14); // of values of 30
}

/// Largest distance to the helix from its spline through nodes at these s, at twenty points per
/// interval of the chord length.
double distance_to_helix(const Values& s) {
  Values chord{0}, x, y, z;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Vec3 r = on_helix(s[i]);
    x.push_back(r.x()), y.push_back(r.y()), z.push_back(r.z());
    if (i > 0) chord.push_back(chord.back() + (r - on_helix(s[i - 1])).norm());
  }
  constexpr std::size_t per_interval = 20;
  const Values at = within(chord, per_interval), at_s = within(s, per_interval);
  const Values px = spline(chord, x, at), py = spline(chord, y, at),
               pz = spline(chord, z, at);
  double worst = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 p(px[i], py[i], pz[i]);
    double foot = at_s[i];
    for (int newton = 0; newton < 5; ++newton) {
      const Vec3 tangent(0.3, -std::sin(foot), std::cos(foot));
      foot += (p - on_helix(foot)).dot(tangent) / tangent.squaredNorm();
    }
    worst = std::max(worst, (p - on_helix(foot)).norm());
  }
  return worst;
}

Values nodes(std::size_t links, const std::function<double(double)>& place) {
  Values s;
  for (std::size_t i = 0; i <= links; ++i) s.push_back(place(real(i) / real(links)));
  return s;
}

// Not the fourth order of a cubic.
TEST(AkimaSpline, is_of_third_order_on_smooth_meshes) {
  const auto even = [](double u) { return two_turns * u; };
  const double coarse = distance_to_helix(nodes(40, even)),
               fine = distance_to_helix(nodes(1280, even));
  EXPECT_NEAR(coarse, 5.864e-4, 0.0005e-4);
  EXPECT_NEAR(fine, 1.740e-8, 0.0005e-8);
  EXPECT_NEAR(std::log2(coarse / fine) / 5, 3.0, 0.05);
  EXPECT_NEAR(std::log2(distance_to_helix(nodes(160, graded))
                        / distance_to_helix(nodes(1280, graded)))
                  / 3,
              3.0, 0.05);
}

TEST(AkimaSpline, loses_an_order_on_jittered_meshes) {
  std::mt19937 bits(1);
  const auto jittered = [&](std::size_t links) {
    Values s = nodes(links, [](double u) { return two_turns * u; });
    for (std::size_t i = 1; i < links; ++i)
      s[i] += 0.3 * two_turns / real(links) * (2 * (real(bits()) / 4294967295.0) - 1);
    return s;
  };
  const double order =
      std::log2(distance_to_helix(jittered(160)) / distance_to_helix(jittered(10240))) / 6;
  EXPECT_NEAR(order, 1.9, 0.2);
}

// Equal arcs of the spline have unequal chords.
TEST(AkimaSpline, equal_arcs_have_equal_chords_to_second_order) {
  for (const auto& [links, uneven, longer] : {std::tuple{40U, 8.78e-2, 4.3e-3},
                                              {80U, 3.41e-2, 1.04e-3},
                                              {160U, 8.87e-3, 2.53e-4},
                                              {320U, 2.31e-3, 6.26e-5},
                                              {640U, 5.79e-4, 1.56e-5},
                                              {1280U, 1.48e-4, 3.9e-6}}) {
    const Values s = nodes(links, graded);
    Values arc{0}, column[3];
    for (std::size_t i = 0; i < s.size(); ++i) {
      const Vec3 r = on_helix(s[i]);
      for (int c = 0; c < 3; ++c) column[c].push_back(r[c]);
      if (i > 0) arc.push_back(arc.back() + (r - on_helix(s[i - 1])).norm());
    }
    const Values at = nodes(links, [&](double u) { return arc.back() * u; });
    for (Values& values : column) values = spline(arc, values, at);
    double shortest = 1e9, longest = 0, total = 0;
    for (std::size_t i = 1; i < at.size(); ++i) {
      const double chord =
          std::hypot(column[0][i] - column[0][i - 1], column[1][i] - column[1][i - 1],
                     column[2][i] - column[2][i - 1]);
      shortest = std::min(shortest, chord), longest = std::max(longest, chord);
      total += chord;
    }
    // The references have two or three digits.
    EXPECT_NEAR((longest / shortest - 1) / uneven, 1, 0.005) << links;
    EXPECT_NEAR((total / arc.back() - 1) / longer, 1, 0.01) << links;
  }
}

// What makes radii by spline dangerous.
TEST(AkimaSpline, can_dip_below_positive_data) {
  const Values a{5e-3, 2.5e-3, 1e-4, 1e-4, 2e-4, 1e-4, 1e-4};
  EXPECT_NEAR(spline(uniform(7), a, {2.3464})[0], -8.481502e-5, 1e-11);
}

} // namespace
} // namespace ehdjet
