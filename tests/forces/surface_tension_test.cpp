#include "ehdjet/forces/surface_tension.hpp"
#include "ehdjet/jet/curvature.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "support/chain.hpp"

namespace ehdjet {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Any three points of a circle, in any plane, off the origin.
TEST(CurvatureVector, points_from_a_circle_to_its_centre_with_one_over_its_radius) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, 2 * pi);
  std::normal_distribution<double> normal;
  for (const double radius : {1e-6, 1.0, 1e6}) {
    std::vector<double> errors;
    for (int i = 0; i < 3000; ++i) {
      const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
      const Vec3 e1 = any().normalized();
      const Vec3 e2 = e1.cross(any()).normalized();
      const Vec3 centre = 6 * radius * any().normalized();
      std::array<Vec3, 3> r;
      for (Vec3& point : r) {
        const double phi = angle(random);
        point = centre + radius * (std::cos(phi) * e1 + std::sin(phi) * e2);
      }
      const Vec3 exact = (centre - r[1]) / (radius * radius);
      const Vec3 k = curvature_vector(r[0] - r[1], r[2] - r[1]);
      const double chord =
          std::min({(r[0] - r[1]).norm(), (r[2] - r[1]).norm(), (r[0] - r[2]).norm()})
          / radius;
      errors.push_back((k - exact).norm() * radius);
      // Coordinates of 7 R are rounded; three points a chord c apart magnify that by R/c^2.
      EXPECT_LE(errors.back(), 7 * 8 * epsilon / (chord * chord)) << radius << " " << chord;
    }
    std::ranges::sort(errors);
    EXPECT_LE(errors[errors.size() / 2], 1e-12) << radius;
  }
}

TEST(CurvatureVector, is_exactly_zero_for_collinear_beads) {
  const Vec3 d(1, 2, -2);
  EXPECT_EQ(curvature_vector(-d, d), Vec3::Zero());
  EXPECT_EQ(curvature_vector(-d, 3 * d), Vec3::Zero());
  EXPECT_EQ(curvature_vector(-4 * d, d), Vec3::Zero());
  EXPECT_EQ(curvature_vector(2 * d, d), Vec3::Zero()); // folded back
}

TEST(CurvatureVector, resolves_an_offset_from_a_straight_line_down_to_round_off) {
  for (double offset = 1e-4; offset > 5e-17; offset /= 10) {
    const Vec3 aside(0, 0.6 * offset, -0.8 * offset);
    const Vec3 k = curvature_vector(Vec3(-1, 0, 0) - aside, Vec3(1, 0, 0) - aside);
    const double exact = 2 * offset / (1 + offset * offset);
    EXPECT_NEAR(k.dot(aside) / (offset * exact), -1, 8 * epsilon) << offset;
    EXPECT_LE(std::abs(k.x()), 8 * epsilon * exact) << offset;
  }
}

TEST(CurvatureVector, stays_finite_when_the_chain_folds_back_on_itself) {
  const Vec3 k = curvature_vector({-1, 0, 0}, {-1, 1e-9, 0});
  EXPECT_NEAR(k.norm(), 2, 1e-14);
  EXPECT_EQ(curvature_vector({-1, 0.5, 2}, {-1, 0.5, 2}), Vec3::Zero());
  EXPECT_EQ(curvature_vector(Vec3::Zero(), {-1, 0.5, 2}), Vec3::Zero());
  EXPECT_EQ(curvature_vector(Vec3::Zero(), Vec3::Zero()), Vec3::Zero());
}

double parabola_curvature(double h) {
  return curvature_vector({-h, h * h / 2, 0}, {h, h * h / 2, 0}).y();
}

TEST(CurvatureVector, converges_at_second_order_on_equal_chords) {
  EXPECT_NEAR(parabola_curvature(0.1), 0.997506234413965, 1e-14);
  EXPECT_NEAR(parabola_curvature(0.05), 0.999375390381012, 1e-14);
  EXPECT_NEAR(parabola_curvature(0.025), 0.999843774410248, 1e-14);
  const double order =
      std::log2((1 - parabola_curvature(0.05)) / (1 - parabola_curvature(0.025)));
  EXPECT_NEAR(order, 2, 0.01);
}

// y = x^2/2 + x^3/6 has curvature 1 and slope of curvature 1 at x = 0.
TEST(CurvatureVector, converges_at_first_order_on_unequal_chords) {
  const auto y = [](double x) { return x * x / 2 + x * x * x / 6; };
  const auto error = [&](double l1, double l2) {
    return curvature_vector({-l1, y(-l1), 0}, {l2, y(l2), 0}).y() - 1;
  };
  for (const double l : {1e-3, 5e-4})
    EXPECT_NEAR(error(l, 2 * l) / l, 1. / 3, 5 * l) << l; // (l2 - l1) k'/3 + O(l^2)
  EXPECT_NEAR(std::log2(error(1e-3, 2e-3) / error(5e-4, 1e-3)), 1, 0.01);
}

constexpr double alpha = 0.021, ring_radius = 0.01, thread_radius = 1e-5;

/// A polygon of n chords in a tilted plane, whose last bead lies on the first.
Chain ring(std::size_t n) {
  const Vec3 e1(1. / 3, 2. / 3, -2. / 3), e2(2. / 3, 1. / 3, 2. / 3);
  Chain chain(n + 1);
  const double step = 2 * pi / static_cast<double>(n);
  const double chord = 2 * ring_radius * std::sin(step / 2);
  for (std::size_t k = 0; k <= n; ++k) {
    const double phi = step * static_cast<double>(k);
    chain.place(k, ring_radius * (std::cos(phi) * e1 + std::sin(phi) * e2));
    chain.volume[k] = pi * thread_radius * thread_radius * chord;
  }
  return chain;
}
double chord_of(std::size_t n) {
  return 2 * ring_radius * std::sin(pi / static_cast<double>(n));
}

/// Inward force per length of thread, checked to be the same on all inner beads.
double inward_pull(Chain& chain, ForceTerm& term) {
  const std::vector<Vec3> f = chain.force(term);
  const std::size_t n = chain.beads - 1;
  const double pull = f[1].norm() / chord_of(n);
  for (std::size_t k = 1; k < n; ++k) {
    const Vec3 inward = -chain.columns().position()[k] / ring_radius;
    // Chords of 2 pi R/n from coordinates of size R, twice.
    const double round_off = 10 * epsilon * static_cast<double>(n * n);
    EXPECT_LE((f[k] / chord_of(n) - pull * inward).norm(), round_off * pull) << k;
  }
  return pull;
}

TEST(LineSurfaceTension, pulls_a_ring_inwards_independently_of_the_mesh) {
  LineSurfaceTension term(alpha);
  const double exact = pi * thread_radius * alpha / ring_radius;
  for (const std::size_t n : {50U, 100U, 200U}) {
    Chain chain = ring(n);
    EXPECT_NEAR(inward_pull(chain, term) / exact, 1, 1e-11) << n;
  }
}

// Known and wanted: published results rest on it.
TEST(BendingSurfaceTension, pulls_each_bead_of_a_ring_whatever_its_length) {
  BendingSurfaceTension term(alpha);
  const double each = pi * thread_radius * thread_radius * alpha / ring_radius;
  for (const std::size_t n : {50U, 100U, 200U}) {
    Chain chain = ring(n);
    EXPECT_NEAR(inward_pull(chain, term) * chord_of(n) / each, 1, 1e-11) << n;
  }
}

Chain curved_chain() {
  Chain chain(7);
  for (std::size_t k = 0; k < 7; ++k) {
    const double s = static_cast<double>(k);
    chain.place(k, 2e-4 * Vec3(s, std::sin(s), std::cos(2 * s)));
    chain.volume[k] = 1e-12 * (1 + s);
  }
  return chain;
}

TEST(BendingSurfaceTension,
     acts_with_the_mean_radius_of_the_two_links_and_not_on_the_ends) {
  Chain chain = curved_chain();
  BendingSurfaceTension term(alpha);
  const std::vector<Vec3> f = chain.force(term);
  EXPECT_EQ(f.front(), Vec3::Zero());
  EXPECT_EQ(f.back(), Vec3::Zero());
  const auto r = chain.columns().position();
  const auto radius = [&](std::size_t k) {
    return std::sqrt(chain.volume[k] / (pi * (r[k] - r[k - 1]).norm()));
  };
  for (std::size_t k = 1; k < 6; ++k) {
    const double mean = (radius(k) + radius(k + 1)) / 2;
    const Vec3 expected =
        alpha * pi * mean * mean * curvature_vector(r[k - 1] - r[k], r[k + 1] - r[k]);
    EXPECT_LE((f[k] - expected).norm(), 20 * epsilon * expected.norm()) << k;
  }
}

TEST(LineSurfaceTension, pulls_both_ends_of_every_link_with_pi_a_alpha) {
  Chain chain = curved_chain();
  LineSurfaceTension term(alpha);
  const std::vector<Vec3> f = chain.force(term);
  const auto r = chain.columns().position();
  const auto tension = [&](std::size_t k) -> Vec3 {
    const Vec3 d = r[k] - r[k - 1];
    return pi * std::sqrt(chain.volume[k] / (pi * d.norm())) * alpha * d.normalized();
  };
  const double round_off = 10 * epsilon * tension(6).norm();
  EXPECT_LE((f[0] - tension(1)).norm(), round_off);
  for (std::size_t k = 1; k < 6; ++k)
    EXPECT_LE((f[k] - (tension(k + 1) - tension(k))).norm(), round_off) << k;
  EXPECT_LE((f[6] + tension(6)).norm(), round_off);
  EXPECT_LE(sum(f).norm(), 7 * epsilon * sum_of_norms(f));
}

TEST(SurfaceTension, both_forms_pass_over_an_embryo) {
  Chain whole = curved_chain();
  Chain without(6); // the same beads but for bead 1
  for (std::size_t k = 0, j = 0; k < 7; ++k) {
    if (k == 1) continue;
    without.place(j, whole.columns().position()[k]);
    without.volume[j++] = whole.volume[k];
  }
  whole.first = 2;
  BendingSurfaceTension paper(alpha);
  LineSurfaceTension line(alpha);
  for (ForceTerm* term :
       {static_cast<ForceTerm*>(&paper), static_cast<ForceTerm*>(&line)}) {
    const std::vector<Vec3> f = whole.force(*term), expected = without.force(*term);
    EXPECT_EQ(f[0], expected[0]) << term->name();
    EXPECT_EQ(f[1], Vec3::Zero()) << term->name();
    for (std::size_t k = 2; k < 7; ++k)
      EXPECT_EQ(f[k], expected[k - 1]) << term->name() << k;
  }
}

} // namespace
} // namespace ehdjet
