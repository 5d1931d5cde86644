#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Values = std::vector<double>;

std::optional<Mesh> plan(const JetState& jet, const MeshRule& rule,
                         std::size_t first_knot = 1) {
  return plan_mesh(JetString(jet), jet, first_knot, rule);
}

/// Lengths of the new links of a mesh.
Values links(const Mesh& mesh, const JetState& jet) {
  Values l;
  double before = JetString(jet).arc_length[mesh.kept];
  for (const double at : mesh.arc_length) l.push_back(at - before), before = at;
  return l;
}

std::string refusal(const JetState& jet) {
  try {
    const JetString string(jet);
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(JetString, measures_the_arc_by_chords) {
  const JetState jet = jet_through({{0, 0, 0}, {3, 4, 0}, {3, 4, 2}, {3, 3, 2}});
  const JetString string(jet);
  EXPECT_EQ(string.arc_length, (Values{0, 5, 7, 8}));
  EXPECT_EQ(string.knots(), 4U);
  EXPECT_EQ(string.length(), 8);
  EXPECT_EQ(string.link(2), 2);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(string.bead(k), k);
  EXPECT_EQ(string.at_knots(jet.mass), jet.mass);
}

TEST(JetString, passes_an_embryo_by) {
  JetState jet = jet_through({{0, 0, 0}, {1, 1, 1}, {3, 4, 0}, {3, 4, 2}});
  jet.has_embryo = true;
  const JetString string(jet);
  EXPECT_EQ(string.arc_length, (Values{0, 5, 7}));
  EXPECT_EQ(string.bead(0), 0U);
  EXPECT_EQ(string.bead(1), 2U);
  EXPECT_EQ(string.bead(2), 3U);
  EXPECT_EQ(string.at_knots(jet.mass), (Values{jet.mass[0], jet.mass[2], jet.mass[3]}));
}

TEST(JetString, names_the_beads_between_which_there_is_no_curve) {
  JetState jet = straight_jet(5, 1);
  jet.columns().position().set(3, jet.columns().position()[2]);
  EXPECT_NE(refusal(jet).find("bead 3 coincides with bead 2"), std::string::npos)
      << refusal(jet);
  EXPECT_NE(refusal(jet).find("t = 0.125 s"), std::string::npos) << refusal(jet);

  jet = straight_jet(5, 1);
  jet.columns().position().y[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(jet).find("bead 4 "), std::string::npos) << refusal(jet);
  EXPECT_NE(refusal(jet).find("bead 3 "), std::string::npos) << refusal(jet);

  jet = straight_jet(5, 1); // behind an embryo beads count differently from knots
  jet.has_embryo = true;
  jet.columns().position().set(2, jet.columns().position()[0]);
  EXPECT_NE(refusal(jet).find("bead 2 coincides with bead 0"), std::string::npos)
      << refusal(jet);
}

// Validation 6.3.
TEST(UniformMesh, starts_at_the_first_link_that_is_too_long) {
  const JetState jet = growing_jet();
  const JetString string(jet);
  EXPECT_NEAR(string.length(), 35.5818061646, 1e-10);
  struct Row {
    double threshold;
    std::size_t s;
    double x_s;
    std::size_t links;
    double length;
  };
  for (const Row& row : {Row{0.2, 17, 1.30150186728, 172, 0.199304094752044},
                         Row{0.4, 22, 2.75263276029, 83, 0.395532209690813},
                         Row{0.8, 27, 5.67137531196, 38, 0.787116601386074}}) {
    const auto mesh = plan(jet, {.length = row.threshold});
    ASSERT_TRUE(mesh) << row.threshold;
    EXPECT_EQ(mesh->kept, row.s);
    EXPECT_NEAR(string.arc_length[mesh->kept] / row.x_s, 1, 1e-11);
    ASSERT_EQ(mesh->arc_length.size(), row.links);
    EXPECT_EQ(mesh->arc_length.back(), string.length());
    for (const double l : links(*mesh, jet)) // differences of places up to 36
      EXPECT_NEAR(l, row.length, 2 * 36 * epsilon);
  }
}

// Validation 6.6: fifteen times 0.2 is 3.0000000000000004.
TEST(UniformMesh, round_off_makes_no_link_more) {
  const JetState fifteen = straight_jet(15, 0.2);
  EXPECT_FALSE(plan(fifteen, {.length = 0.2}, 0));
  std::vector<Vec3> places; // ... nor makes it such a link too long
  for (std::size_t k = 0; k <= 15; ++k) places.emplace_back(0.2 * real(k), 0, 0);
  places.emplace_back(8, 0, 0);
  EXPECT_EQ(plan(jet_through(places), {.length = 0.2}, 0)->kept, 15U);
  const JetState three = straight_jet(Values{3.0000000000000004});
  const auto mesh = plan(three, {.length = 0.2}, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->arc_length.size(), 15U);
  // What is really longer than fifteen links takes sixteen.
  EXPECT_EQ(plan(straight_jet(Values{3.000001}), {.length = 0.2}, 0)->arc_length.size(),
            16U);
}

TEST(UniformMesh, leaves_a_mesh_alone_that_is_uniform_already) {
  for (const double length : {0.1, 0.2, 0.3, 0.7, 1.0 / 3})
    for (const std::size_t n : {1U, 7U, 15U, 1000U})
      for (const double turn : {0.0, 0.1}) {
        std::vector<Vec3> places{Vec3::Zero()};
        for (std::size_t i = 0; i < n; ++i)
          places.push_back(
              places.back()
              + length * Vec3(std::cos(turn * real(i)), std::sin(turn * real(i)), 0));
        EXPECT_FALSE(plan(jet_through(places), {.length = length}, 0))
            << length << ' ' << n;
      }
}

TEST(UniformMesh, leaves_a_jet_alone_that_would_get_no_further_bead) {
  // The last link is too long, but half of the others would do.
  const JetState jet = straight_jet(Values{1.5, 0.1, 0.1, 0.1});
  EXPECT_FALSE(plan(jet, {.length = 1}, 0));
  EXPECT_FALSE(plan(straight_jet(Values{1.5, 0.4, 0.1}), {.length = 1}, 0));
  EXPECT_EQ(plan(straight_jet(Values{2.5, 0.1}), {.length = 1}, 0)->arc_length.size(), 3U);
}

TEST(UniformMesh, the_link_that_is_fed_is_nobodys_business) {
  const JetState jet = straight_jet(Values{5, 1, 1, 1});
  EXPECT_FALSE(plan(jet, {.length = 1}, 1));
  const auto mesh = plan(jet, {.length = 1}, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->kept, 0U);
  EXPECT_EQ(mesh->arc_length.size(), 8U);
}

TEST(UniformMesh, stays_within_the_links_allowed) {
  const JetState jet = straight_jet(Values{0.5, 0.5, 4, 4, 4});
  for (const auto& [most, expected] : {std::pair{14U, 12U},
                                       {13U, 11U},
                                       {6U, 4U},
                                       {5U, 0U},
                                       {2U, 0U},
                                       {1U, 0U},
                                       {0U, 0U}}) {
    const auto mesh = plan(jet, {.length = 1, .most_links = most});
    EXPECT_EQ(mesh ? mesh->arc_length.size() : 0, expected) << most;
    EXPECT_TRUE(!mesh || mesh->kept == 2) << most;
  }
  JetState fed = straight_jet(Values{0.25, 0.25, 0.5, 4, 4, 4}); // the same with an embryo
  fed.has_embryo = true;
  EXPECT_EQ(plan(fed, {.length = 1, .most_links = 14})->arc_length.size(), 11U);
}

/// The local length of links for phi/<phi> = 2 s/S is L~ (1 + strength) / (1 + 2 strength s/S):
/// every new link makes up one part of the integral of its inverse.
void expect_equal_weights(const JetState& jet, const MeshRule& rule, double tolerance) {
  const auto mesh = plan(jet, rule, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->kept, 0U);
  const double whole = JetString(jet).length();
  EXPECT_NEAR(real(mesh->arc_length.size()), whole / rule.length,
              1 + tolerance * real(mesh->arc_length.size()));
  double at = 0;
  const Values l = links(*mesh, jet);
  const double share = whole / real(l.size());
  for (std::size_t j = 0; j < l.size(); ++j) {
    const double middle = at + l[j] / 2;
    const double weight = (1 + 2 * rule.strength * middle / whole) / (1 + rule.strength);
    EXPECT_NEAR(weight * l[j] / share, 1, tolerance) << j;
    at += l[j];
  }
}

constexpr std::size_t fine = 200;
constexpr MeshRule weighted{.length = 0.25, .strength = 2};

MeshRule by(MeshWeight weight) {
  MeshRule rule = weighted;
  rule.weight = weight;
  return rule;
}

/// Radii or stresses that grow linearly from zero along a straight jet with links of length 1.
JetState with_growing_radius() {
  JetState jet = straight_jet(fine, 1);
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    const double a = 1e-3 * (real(k) - 0.5);
    jet.volume[k] = std::numbers::pi * a * a;
  }
  return jet;
}
JetState with_growing_stress() {
  JetState jet = straight_jet(fine, 1);
  for (std::size_t k = 0; k < jet.beads(); ++k)
    jet.columns().stress()[k] = (k % 2 == 0 ? 50 : -50) * (real(k) - 0.5);
  return jet;
}
/// A clothoid: curvature proportional to the arc.
JetState with_growing_curvature() {
  std::vector<Vec3> places{Vec3::Zero()};
  for (std::size_t k = 0; k < fine; ++k) {
    const double s = real(k) + 0.5, angle = 0.5 * 0.002 * s * s;
    places.push_back(places.back() + Vec3(std::cos(angle), 0, std::sin(angle)));
  }
  return jet_through(places);
}

// One old link is a two hundredth of the jet; where the weight is least, so much of it changes
// along one.
TEST(WeightedMesh, distributes_the_radius_equally) {
  expect_equal_weights(with_growing_radius(), by(MeshWeight::radius), 0.02);
}
TEST(WeightedMesh, distributes_the_magnitude_of_the_stress_equally) {
  expect_equal_weights(with_growing_stress(), by(MeshWeight::stress), 0.02);
}
TEST(WeightedMesh, distributes_the_curvature_equally) {
  JetState jet = with_growing_curvature();
  const MeshRule rule = by(MeshWeight::curvature);
  const auto mesh = plan(jet, rule, 0);
  ASSERT_TRUE(mesh);
  const double whole = JetString(jet).length();
  const Values l = links(*mesh, jet);
  double at = 0;
  for (std::size_t j = 0; j < l.size(); ++j) {
    const double middle = at + l[j] / 2;
    at += l[j];
    if (middle > whole - 1) break; // half of the last link has no curvature
    EXPECT_NEAR((1 + 4 * middle / whole) / 3 * l[j] / (whole / real(l.size())), 1, 0.03)
        << j;
  }
}

// As long as no link is only a little too long: a weighted mesh tolerates a quarter.
TEST(WeightedMesh, of_strength_zero_is_the_uniform_mesh) {
  for (const auto& [weight, jet] :
       {std::pair{MeshWeight::radius, growing_jet()},
        {MeshWeight::stress, with_growing_stress()},
        {MeshWeight::curvature, graded_helix(40)},
        {MeshWeight::radius, straight_jet(Values{0.001, 0.002, 9, 0.001, 3})}}) {
    const double length = JetString(jet).length() / 4000.5;
    const auto uniform = plan(jet, {.length = length}, 0);
    const auto mesh = plan(jet, {.length = length, .weight = weight, .strength = 0}, 0);
    ASSERT_TRUE(uniform && mesh);
    EXPECT_EQ(mesh->kept, uniform->kept);
    ASSERT_EQ(mesh->arc_length.size(), uniform->arc_length.size());
    for (std::size_t j = 0; j < mesh->arc_length.size(); ++j)
      EXPECT_NEAR(mesh->arc_length[j] / uniform->arc_length[j], 1, 1e-12) << j;
  }
}

// The end beads lie on the curve as well.
TEST(WeightedMesh, of_constant_curvature_is_uniform) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i <= 40; ++i)
    places.push_back(on_helix(two_turns * real(i) / 40));
  const JetState jet = jet_through(places);
  const double length = JetString(jet).length() / 200;
  const auto mesh =
      plan(jet, {.length = length, .weight = MeshWeight::curvature, .strength = 2}, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->arc_length.size(), 200U);
  const Values l = links(*mesh, jet);
  EXPECT_NEAR(std::ranges::min(l) / length, 1, 1e-10);
  EXPECT_NEAR(std::ranges::max(l) / length, 1, 1e-10);
}

TEST(WeightedMesh, keeps_its_links_within_the_limits) {
  JetState jet = straight_jet(fine, 1);
  for (std::size_t k = 0; k < jet.beads(); ++k)
    jet.columns().stress()[k] = k == 90 || k == 91 ? 1000 : 1; // thousandfold
  const MeshRule rule{.length = 0.5,
                      .weight = MeshWeight::stress,
                      .strength = 100,
                      .shortest = 0.02,
                      .longest = 0.8};
  const auto mesh = plan(jet, rule, 0);
  ASSERT_TRUE(mesh);
  const Values l = links(*mesh, jet);
  // Their number is rounded up.
  EXPECT_GE(std::ranges::min(l), 0.02 * (1 - 1 / real(l.size())));
  EXPECT_LE(std::ranges::max(l), 0.8 * (1 + 1e-12));
  EXPECT_LT(std::ranges::min(l), 0.02 * 1.01) << "the limits act";
  EXPECT_GT(std::ranges::max(l), 0.8 * 0.99);
  MeshRule unlimited = rule;
  unlimited.shortest = 0, unlimited.longest = std::numeric_limits<double>::infinity();
  const Values free = links(*plan(jet, unlimited, 0), jet);
  EXPECT_LT(std::ranges::min(free), 0.02 * 0.9);
  EXPECT_GT(std::ranges::max(free), 0.8 * 1.1);
}

TEST(WeightedMesh, stays_within_the_links_allowed) {
  MeshRule rule = by(MeshWeight::radius);
  rule.most_links = 311;
  EXPECT_EQ(plan(with_growing_radius(), rule, 0)->arc_length.size(), 311U);
  rule.most_links = fine;
  EXPECT_FALSE(plan(with_growing_radius(), rule, 0));
}

TEST(WeightedMesh, of_a_straight_unstressed_jet_is_uniform) {
  JetState jet = straight_jet(10, 1); // no curvature, no stress: no mean to compare with
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    jet.columns().stress()[k] = 0;
    jet.columns().position().set(k, {real(k), 0, 0}); // collinear to the last bit
  }
  for (const MeshWeight weight : {MeshWeight::curvature, MeshWeight::stress}) {
    const auto mesh = plan(jet, {.length = 0.5, .weight = weight, .strength = 3}, 0);
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->arc_length.size(), 20U);
    for (const double l : links(*mesh, jet)) EXPECT_NEAR(l, 0.5, 1e-14);
  }
}

} // namespace
} // namespace ehdjet
