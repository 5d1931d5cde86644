#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <utility>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// A curved jet with long and short links.
JetState uneven_jet(std::size_t links) {
  std::vector<Vec3> places;
  double s = 0;
  for (std::size_t i = 0; i <= links; ++i) {
    places.push_back(on_helix(s));
    s += i % 7 < 4 ? 0.02 : 0.3;
  }
  return jet_through(places);
}

RefinementRule joining(double coarsen, double length = 1e9) {
  RefinementRule rule;
  rule.length = length, rule.coarsen = coarsen;
  return rule;
}

TEST(Coarsening, keeps_what_links_and_beads_carry) {
  JetState jet = uneven_jet(200);
  const Sums before(jet);
  const auto change = coarsen_jet(jet, joining(0.1));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->before, 200U);
  EXPECT_EQ(change->after, jet.links());
  EXPECT_LT(jet.links(), 160U);
  const Sums after(jet);
  EXPECT_NEAR(after.volume / before.volume, 1, 1e-14);
  EXPECT_NEAR(after.mass / before.mass, 1, 1e-14);
  EXPECT_NEAR(after.charge / before.charge, 1, 1e-14);
  EXPECT_LE((after.momentum - before.momentum).norm(), 1e-14 * before.momentum_scale);
  EXPECT_NEAR(after.stress / before.stress, 1, 1e-14);
  EXPECT_LT(after.kinetic, before.kinetic);
  EXPECT_LT(after.elastic, before.elastic);
}

TEST(Coarsening, joins_a_link_that_is_no_thread_any_more_with_its_neighbour) {
  for (const std::size_t stub : {2U, 5U}) { // inside, and at the end of the jet
    std::vector<double> links(6, 1.0);
    links[stub] = 0.01;
    JetState jet = straight_jet(links);
    for (double& v : jet.volume) v = 1e-4; // radii of 0.0056, and 0.056 of the stub
    RefinementRule rule;
    rule.length = 1e9, rule.shortest = 0.1;
    EXPECT_FALSE(has_short_links(jet, rule));
    rule.shortest = 1;
    EXPECT_TRUE(has_short_links(jet, rule));
    const double volume = std::accumulate(jet.volume.begin(), jet.volume.end(), 0.0);
    ASSERT_TRUE(coarsen_jet(jet, rule));
    EXPECT_EQ(jet.links(), 5U);
    EXPECT_NEAR(std::accumulate(jet.volume.begin(), jet.volume.end(), 0.0), volume, 1e-18);
    EXPECT_FALSE(has_short_links(jet, rule));
  }
}

// Or cutting and joining would never end.
TEST(Coarsening, joins_no_stubs_that_would_be_cut_into_stubs_at_once) {
  JetState jet = straight_jet(std::vector<double>(6, 0.6));
  for (double& v : jet.volume) v = 1e-2; // radii of 0.073
  RefinementRule rule;
  rule.length = 1, rule.shortest = 10;
  EXPECT_FALSE(has_short_links(jet, rule)); // 1.2 would be cut into 0.6, less than 10 radii
  rule.length = 2;                          // joined links stay whole
  EXPECT_TRUE(has_short_links(jet, rule));
}

TEST(Coarsening, joins_two_links_into_one_with_their_contents) {
  const std::vector<double> links{1, 1, 0.2, 0.3, 1, 1};
  const JetState old = straight_jet(links);
  JetState jet = old;
  const auto change = coarsen_jet(jet, joining(0.6));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 2U);
  ASSERT_EQ(jet.links(), 5U);
  for (const auto& [now, then] :
       {std::pair{0U, 0U}, {1U, 1U}, {2U, 2U}, {4U, 5U}, {5U, 6U}})
    expect_same_bead(jet, now, old, then);
  const Bead a = bead_at(old, 3), b = bead_at(old, 4), joined = bead_at(jet, 3);
  EXPECT_EQ(joined.position, b.position);
  EXPECT_EQ(joined.volume, a.volume + b.volume);
  EXPECT_EQ(joined.mass, a.mass + b.mass);
  EXPECT_EQ(joined.charge, a.charge + b.charge);
  const Vec3 v = (a.mass * a.velocity + b.mass * b.velocity) / (a.mass + b.mass);
  EXPECT_LE((joined.velocity - v).norm(), 4 * epsilon * v.norm());
  EXPECT_NEAR(stress_of(joined),
              (a.volume * stress_of(a) + b.volume * stress_of(b)) / (a.volume + b.volume),
              4 * epsilon * stress_of(joined));
}

TEST(Coarsening, works_without_stresses) {
  JetState jet = uneven_jet(50);
  jet.y.resize(6 * jet.beads()), jet.table = BeadTable::basic();
  const Sums before(jet);
  ASSERT_TRUE(coarsen_jet(jet, joining(0.1)));
  EXPECT_EQ(jet.y.size(), 6 * jet.beads());
  EXPECT_LE((Sums(jet).momentum - before.momentum).norm(), 1e-14 * before.momentum_scale);
}

TEST(Coarsening, leaves_the_insertion_zone_alone) {
  for (const bool embryo : {false, true}) {
    const JetState old = [&] {
      JetState fed = straight_jet(9, 0.1);
      fed.has_embryo = embryo;
      return fed;
    }();
    JetState jet = old;
    ASSERT_TRUE(coarsen_jet(jet, joining(1)));
    const std::size_t zone = old.first();
    for (std::size_t k = 0; k <= zone; ++k) expect_same_bead(jet, k, old, k);
    EXPECT_NEAR(distance(jet, zone + 1, zone), 0.2, 1e-15);
    EXPECT_EQ(jet.links(), embryo ? 6U : 5U); // 2 + (2 2 2 1), 1 + (2 2 2 2)
    EXPECT_EQ(jet.has_embryo, embryo);
  }
  JetState chain = straight_jet(9, 0.1);
  RefinementRule rule = joining(1);
  rule.has_nozzle = false;
  ASSERT_TRUE(coarsen_jet(chain, rule));
  EXPECT_EQ(chain.links(), 5U); // (2 2 2 2 1)
  EXPECT_NEAR(distance(chain, 1, 0), 0.2, 1e-15);
}

TEST(Coarsening, leaves_landed_beads_alone_and_their_records_follow) {
  const JetState old = [] {
    JetState jet = straight_jet(9, 0.1);
    jet.landed = {{.bead = 5, .time = 1, .radius = 2}, {.bead = 9, .time = 3, .radius = 4}};
    return jet;
  }();
  JetState jet = old;
  ASSERT_TRUE(coarsen_jet(jet, joining(1)));
  // 1 | 2+3 | 4 | 5 | 6+7 | 8 | 9
  ASSERT_EQ(jet.links(), 7U);
  ASSERT_EQ(jet.landed.size(), 2U);
  EXPECT_EQ(jet.landed[0].bead, 4U);
  EXPECT_EQ(jet.landed[0].time, 1);
  EXPECT_EQ(jet.landed[0].radius, 2);
  EXPECT_EQ(jet.landed[1].bead, 7U);
  EXPECT_EQ(jet.landed[1].time, 3);
  EXPECT_EQ(jet.landed[1].radius, 4);
  expect_same_bead(jet, 4, old, 5);
  expect_same_bead(jet, 7, old, 9);
  EXPECT_EQ(jet.time, old.time);
}

TEST(Coarsening, leaves_a_jet_alone_without_short_links) {
  for (const std::size_t links : {0U, 1U, 2U, 30U}) {
    const JetState old = straight_jet(links, 0.5);
    JetState jet = old;
    EXPECT_FALSE(coarsen_jet(jet, joining(0.99)));
    expect_same_jet(jet, old);
  }
}

TEST(Coarsening, without_a_length_is_a_contract_violation) {
  JetState jet = straight_jet(5, 1);
  EXPECT_THROW((void)coarsen_jet(jet, RefinementRule{}), ContractViolation);
}

TEST(Coarsening, ends) {
  JetState jet = straight_jet(300, 0.01);
  std::size_t times = 0;
  while (coarsen_jet(jet, joining(0.5))) ASSERT_LT(++times, 10U); // halves each time
  for (std::size_t k = 3; k < jet.beads(); ++k)
    EXPECT_GT(distance(jet, k, k - 1) + distance(jet, k - 1, k - 2), 0.5);
}

// A scene may join links up to half of the threshold.
TEST(Coarsening, does_not_undo_refinement_nor_refinement_it) {
  const RefinementRule rule = joining(0.1, 0.2);
  JetState jet = uneven_jet(200); // links of 0.02 and 0.3
  while (coarsen_jet(jet, rule)) {
  }
  ASSERT_TRUE(refine_jet(jet, rule));
  const JetState refined = jet;
  EXPECT_FALSE(coarsen_jet(jet, rule)) << "joined what had just been cut";
  expect_same_jet(jet, refined);

  JetState short_links = uneven_jet(3); // before the first long link
  ASSERT_TRUE(coarsen_jet(short_links, rule));
  EXPECT_FALSE(refine_jet(short_links, rule)) << "cut what had just been joined";
}

} // namespace
} // namespace ehdjet
