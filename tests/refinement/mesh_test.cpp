#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Values = std::vector<double>;

std::optional<Mesh> plan(const JetState& jet, double length, std::size_t first_knot = 1) {
  return plan_mesh(JetString(jet), first_knot, length);
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

TEST(NewMesh, starts_at_the_first_link_that_is_too_long) {
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
    const auto mesh = plan(jet, row.threshold);
    ASSERT_TRUE(mesh) << row.threshold;
    EXPECT_EQ(mesh->kept, row.s);
    EXPECT_NEAR(string.arc_length[mesh->kept] / row.x_s, 1, 1e-11);
    ASSERT_EQ(mesh->arc_length.size(), row.links);
    EXPECT_EQ(mesh->arc_length.back(), string.length());
    for (const double l : links(*mesh, jet)) // differences of places up to 36
      EXPECT_NEAR(l, row.length, 2 * 36 * epsilon);
  }
}

// Fifteen times 0.2 is 3.0000000000000004.
TEST(NewMesh, round_off_makes_no_link_more) {
  const JetState fifteen = straight_jet(15, 0.2);
  EXPECT_FALSE(plan(fifteen, 0.2, 0));
  std::vector<Vec3> places; // ... nor makes it such a link too long
  for (std::size_t k = 0; k <= 15; ++k) places.emplace_back(0.2 * real(k), 0, 0);
  places.emplace_back(8, 0, 0);
  EXPECT_EQ(plan(jet_through(places), 0.2, 0)->kept, 15U);
  const JetState three = straight_jet(Values{3.0000000000000004});
  const auto mesh = plan(three, 0.2, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->arc_length.size(), 15U);
  // What is really longer than fifteen links takes sixteen.
  EXPECT_EQ(plan(straight_jet(Values{3.000001}), 0.2, 0)->arc_length.size(), 16U);
}

TEST(NewMesh, leaves_a_mesh_alone_that_is_uniform_already) {
  for (const double length : {0.1, 0.2, 0.3, 0.7, 1.0 / 3})
    for (const std::size_t n : {1U, 7U, 15U, 1000U})
      for (const double turn : {0.0, 0.1}) {
        std::vector<Vec3> places{Vec3::Zero()};
        for (std::size_t i = 0; i < n; ++i)
          places.push_back(
              places.back()
              + length * Vec3(std::cos(turn * real(i)), std::sin(turn * real(i)), 0));
        EXPECT_FALSE(plan(jet_through(places), length, 0)) << length << ' ' << n;
      }
}

TEST(NewMesh, leaves_a_jet_alone_that_would_get_no_further_bead) {
  // The last link is too long, but half of the others would do.
  const JetState jet = straight_jet(Values{1.5, 0.1, 0.1, 0.1});
  EXPECT_FALSE(plan(jet, 1, 0));
  EXPECT_FALSE(plan(straight_jet(Values{1.5, 0.4, 0.1}), 1, 0));
  EXPECT_EQ(plan(straight_jet(Values{2.5, 0.1}), 1, 0)->arc_length.size(), 3U);
}

TEST(NewMesh, leaves_the_link_alone_that_is_being_fed) {
  const JetState jet = straight_jet(Values{5, 1, 1, 1});
  EXPECT_FALSE(plan(jet, 1, 1));
  const auto mesh = plan(jet, 1, 0);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->kept, 0U);
  EXPECT_EQ(mesh->arc_length.size(), 8U);
}

} // namespace
} // namespace ehdjet
