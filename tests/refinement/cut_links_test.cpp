#include "ehdjet/refinement/akima_spline.hpp"
#include "ehdjet/refinement/jet_string.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;

RefinementRule cutting(double length) {
  RefinementRule rule;
  rule.length = length;
  return rule;
}

/// A helix whose links number 5 and 9 are too long for the rule.
JetState with_two_long_links() {
  std::vector<Vec3> places;
  double s = 0;
  for (std::size_t i = 0; i <= 14; ++i) {
    places.push_back(on_helix(s));
    s += i == 4 ? 0.45 : i == 8 ? 0.25 : 0.15;
  }
  return jet_through(places);
}

TEST(Cuts, leave_all_other_beads_as_they_are) {
  const JetState old = with_two_long_links();
  JetState jet = old;
  ASSERT_TRUE(has_long_link(jet, cutting(0.2)));
  const auto change = cut_links(jet, cutting(0.2));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 4U);
  EXPECT_EQ(change->before, 14U);
  EXPECT_EQ(change->after, 17U); // three parts, and two
  ASSERT_EQ(jet.links(), 17U);
  EXPECT_FALSE(has_long_link(jet, cutting(0.2)));
  EXPECT_LT(change->worst_link, 0.02);
  const auto place = [](std::size_t k) { return k < 5 ? k : k < 9 ? k + 2 : k + 3; };
  for (std::size_t k = 0; k <= 14; ++k)
    for (std::size_t c = 0; c < (k == 5 || k == 9 ? 6U : 7U);
         ++c) // links have new stresses
      EXPECT_EQ(jet.columns().column(c)[place(k)], old.columns().column(c)[k]) << k << c;
  for (std::size_t k = 1; k <= 14; ++k)
    if (k != 5 && k != 9) {
      EXPECT_EQ(jet.volume[place(k)], old.volume[k]);
      EXPECT_EQ(jet.mass[place(k)], old.mass[k]);
      EXPECT_EQ(jet.charge[place(k)], old.charge[k]);
    }
}

// Volume, mass, charge and volume times stress of a link are those of its parts.
TEST(Cuts, share_out_what_a_link_has) {
  const JetState old = with_two_long_links();
  JetState jet = old;
  cut_links(jet, cutting(0.2));
  for (const auto& [link, first, parts] : {std::array{5U, 5U, 3U}, {9U, 11U, 2U}}) {
    double volume = 0, mass = 0, charge = 0, stress = 0;
    for (std::size_t k = first; k < first + parts; ++k) {
      EXPECT_GT(jet.volume[k], 0);
      EXPECT_NEAR(jet.mass[k] / jet.volume[k], old.mass[link] / old.volume[link], 1e-14);
      volume += jet.volume[k], mass += jet.mass[k], charge += jet.charge[k];
      stress += jet.volume[k] * stress_of(jet.columns())[k];
    }
    EXPECT_NEAR(volume / old.volume[link], 1, 1e-15);
    EXPECT_NEAR(mass / old.mass[link], 1, 1e-15);
    EXPECT_NEAR(charge / old.charge[link], 1, 1e-15);
    EXPECT_NEAR(stress / (old.volume[link] * stress_of(old.columns())[link]), 1, 1e-14);
  }
}

// The section of this jet falls linearly: so do those of the parts. Extrema stay as they are.
TEST(Cuts, follow_a_thinning_jet) {
  std::vector<double> links(9, 1.0);
  links[4] = 2;
  JetState jet = straight_jet(links);
  double middle = 0;
  for (std::size_t k = 1; k <= 9; ++k) {
    middle += links[k - 1] / 2;
    jet.volume[k] = links[k - 1] * (10 - 0.7 * middle);
    stress_of(jet.columns())[k] = 3 + 0.4 * middle;
    middle += links[k - 1] / 2;
  }
  JetState uniform = jet;
  for (std::size_t k = 1; k <= 9; ++k) uniform.volume[k] = links[k - 1];
  ASSERT_TRUE(cut_links(jet, cutting(1.5)));
  EXPECT_NEAR(jet.volume[5], 10 - 0.7 * 4.5, 1e-14);
  EXPECT_NEAR(jet.volume[6], 10 - 0.7 * 5.5, 1e-14);
  EXPECT_NEAR(stress_of(jet.columns())[6] - stress_of(jet.columns())[5], 0.4, 1e-14);
  ASSERT_TRUE(cut_links(uniform, cutting(1.5)));
  EXPECT_EQ(uniform.volume[5], 1);
  EXPECT_EQ(uniform.volume[6], 1);
}

// On the spline through all beads of the string, though only a few are looked at.
TEST(Cuts, put_new_beads_on_the_curve_through_all) {
  const JetState old = with_two_long_links();
  JetState jet = old;
  cut_links(jet, cutting(0.2));
  const JetString string(old);
  AkimaSpline spline(string.arc_length);
  const double start = string.arc_length[4], l = string.arc_length[5] - start;
  const std::vector<double> at{start + l / 3, start + 2 * l / 3};
  for (std::size_t c = 0; c < 6; ++c) {
    std::vector<double> values(2);
    spline.interpolate(string.at_knots(old.columns().column(c)), at, values);
    EXPECT_NEAR(jet.columns().column(c)[5], values[0], 1e-13) << c;
    EXPECT_NEAR(jet.columns().column(c)[6], values[1], 1e-13) << c;
  }
}

// The link next to a nozzle is being fed, and so is the one behind an embryo.
TEST(Cuts, leave_the_link_at_the_nozzle_alone) {
  JetState jet = straight_jet(std::vector<double>{5, 1, 1});
  EXPECT_FALSE(cut_links(jet, cutting(2)));
  RefinementRule chain = cutting(2);
  chain.has_nozzle = false;
  EXPECT_TRUE(cut_links(jet, chain));
  JetState born = straight_jet(std::vector<double>{1, 4, 1, 5, 1});
  born.has_embryo = true;
  const auto change = cut_links(born, cutting(2));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 3U);
  EXPECT_EQ(change->after, 7U);
}

TEST(Cuts, keep_landed_beads_and_stay_before_the_collector) {
  JetState jet = straight_jet(std::vector<double>{1, 1, 1, 3});
  jet.landed.push_back({.bead = 4, .time = 0.1, .radius = 0.3});
  RefinementRule rule = cutting(1.5);
  rule.collector = jet.columns().position().x[4] - 0.2;
  ASSERT_TRUE(cut_links(jet, rule));
  ASSERT_EQ(jet.links(), 5U);
  ASSERT_EQ(jet.landed.size(), 1U);
  EXPECT_EQ(jet.landed[0].bead, 5U);
  EXPECT_EQ(jet.landed[0].radius, 0.3);
  EXPECT_LE(jet.columns().position().x[4], *rule.collector);
}

TEST(Cuts, refuse_a_mesh_that_no_memory_holds) {
  JetState jet = straight_jet(std::vector<double>{1, 1, 1});
  EXPECT_THROW(cut_links(jet, cutting(1e-8)), RunError);
}

} // namespace
} // namespace ehdjet
