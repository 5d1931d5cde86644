#include "ehdjet/refinement/refine_jet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "refinement/jets.hpp"

namespace ehdjet {
namespace {

using namespace test;

RefinementRule cut(double length) {
  RefinementRule rule;
  rule.length = length;
  return rule;
}

/// Every way to move what links carry.
std::vector<RefinementRule> link_remaps(double length) {
  std::vector<RefinementRule> rules(2, cut(length));
  rules[1].remap = LinkRemap::paper;
  return rules;
}
std::string name(const RefinementRule& rule) {
  return rule.remap == LinkRemap::paper ? "paper" : "conservative";
}

/// Every tenth link holds a tenth more.
JetState varicose(JetState jet, double volume) {
  for (std::size_t k = 0; k < jet.beads(); ++k)
    jet.volume[k] = k % 10 == 5 ? 1.1 * volume : volume;
  return jet;
}

void expect_kept_beads(const JetState& jet, const JetState& old, std::size_t s) {
  for (std::size_t k = 0; k <= s; ++k) expect_same_bead(jet, k, old, k);
}

// --- what links carry ------------------------------------------------------------------------

TEST(Refinement, keeps_volume_mass_and_charge) {
  for (const double length : {0.2, 0.4, 0.8})
    for (const RefinementRule& rule : link_remaps(length))
      for (const bool bumps : {false, true}) {
        const JetState old = bumps ? varicose(growing_jet(), 0.7) : growing_jet();
        JetState jet = old;
        const auto change = refine_jet(jet, rule);
        ASSERT_TRUE(change);
        EXPECT_EQ(change->before, 40U);
        EXPECT_EQ(change->after, jet.links());
        EXPECT_EQ(change->kept, length == 0.2 ? 17U : length == 0.4 ? 22U : 27U);
        EXPECT_EQ(jet.links(), change->kept
                                   + (length == 0.2   ? 172U
                                      : length == 0.4 ? 83U
                                                      : 38U));
        expect_kept_beads(jet, old, change->kept);
        const Sums before(old), after(jet);
        EXPECT_NEAR(after.volume / before.volume, 1, 1e-14) << name(rule) << length;
        EXPECT_NEAR(after.mass / before.mass, 1, 1e-14) << name(rule) << length;
        EXPECT_NEAR(after.charge / before.charge, 1, 1e-14) << name(rule) << length;
      }
}

TEST(Refinement, keeps_volume_mass_and_charge_two_hundred_times) {
  for (const RefinementRule& rule : link_remaps(0.2)) {
    JetState jet = varicose(straight_jet(20, 0.1), 0.7);
    const Sums before(jet);
    for (int t = 0; t < 200; ++t) {
      const auto r = jet.columns().position();
      for (std::size_t k = 0; k < jet.beads(); ++k) r.set(k, 1.025 * r[k]);
      (void)refine_jet(jet, rule);
    }
    EXPECT_GT(jet.links(), 1000U);
    const Sums after(jet);
    EXPECT_NEAR(after.volume / before.volume, 1, 1e-12) << name(rule);
    EXPECT_NEAR(after.mass / before.mass, 1, 1e-12) << name(rule);
    EXPECT_NEAR(after.charge / before.charge, 1, 1e-12) << name(rule);
  }
}

TEST(Refinement, keeps_the_excess_of_every_varicose_bump) {
  const double V0 = 0.7, born = 0.02, stretched = 200 * born;
  const auto bumpy = [&](bool bumps) {
    JetState jet = straight_jet(60, born);
    const auto c = jet.columns();
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      c.position().set(k, 200 * c.position()[k]);
      jet.volume[k] = V0, jet.mass[k] = 3, jet.charge[k] = 5;
    }
    return bumps ? varicose(std::move(jet), V0) : jet;
  };
  JetState jet = bumpy(true), smooth = bumpy(false);
  const auto change = refine_jet(jet, cut(0.2));
  ASSERT_TRUE(change && refine_jet(smooth, cut(0.2)));
  EXPECT_EQ(change->kept, 1U);
  EXPECT_EQ(jet.links(), 1U + 59U * 20U);
  // A window of three old links around each bump.
  const auto x = [&](std::size_t k) { return along.dot(jet.columns().position()[k]); };
  for (std::size_t bump = 5; bump < 60; bump += 10) {
    const double start = (real(bump) - 2) * stretched, end = (real(bump) + 1) * stretched;
    CompensatedSum excess;
    for (std::size_t k = 2; k < jet.beads(); ++k)
      if (x(k - 1) > start - 0.1 && x(k) < end + 0.1) {
        excess += jet.volume[k], excess += -V0 * (0.2 / stretched);
        const bool within = x(k) - 0.1 > (real(bump) - 1) * stretched
                            && x(k) - 0.1 < real(bump) * stretched;
        // A radius ratio of sqrt(1.1) = 1.0488.
        EXPECT_NEAR(link_radius(jet.volume[k], link_length(jet, k))
                        / link_radius(V0, stretched),
                    within ? std::sqrt(1.1) : 1, 1e-11)
            << k;
      }
    EXPECT_NEAR(excess / (0.1 * V0), 1, 1e-12) << bump;
  }
  EXPECT_EQ(jet.y, smooth.y) << "a bump in volume is none in velocity";
  EXPECT_EQ(jet.mass, smooth.mass);
  EXPECT_EQ(jet.charge, smooth.charge);
  for (std::size_t k = 2; k < jet.beads(); ++k) {
    EXPECT_NEAR(jet.charge[k], 5. / 20, 1e-12) << k;
    EXPECT_NEAR(jet.mass[k], 3. / 20, 1e-12) << k;
  }
}

// Radii through which Akima's curve dips below zero.
TEST(Refinement, the_papers_radii_stay_between_those_of_their_neighbours) {
  const std::vector<double> radius{5e-3, 5e-3, 2.5e-3, 1e-4, 1e-4, 2e-4, 1e-4, 1e-4};
  JetState jet = straight_jet(7, 1);
  for (std::size_t k = 0; k < jet.beads(); ++k)
    jet.volume[k] = std::numbers::pi * radius[k] * radius[k];
  RefinementRule rule = cut(0.01);
  rule.remap = LinkRemap::paper, rule.has_nozzle = false;
  ASSERT_TRUE(refine_jet(jet, rule));
  ASSERT_EQ(jet.links(), 700U);
  // One factor, the same for all, makes up for the volume.
  double least = 0, most = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    ASSERT_GT(jet.volume[k], 0) << k;
    const std::size_t i = (k + 99) / 100; // the old bead at or behind it
    const auto [low, high] = std::minmax(radius[i - 1], radius[i]);
    const double a = link_radius(jet.volume[k], link_length(jet, k));
    least = std::max(least, a / high), most = std::min(most, a / low);
  }
  EXPECT_LE(least, most * (1 + 1e-12));
  EXPECT_NEAR(most, 1, 0.2) << "a factor of order one";
}

// The volume that the paper's radii would make from nothing, relative to the
// jet's. The last radius is an old one and tells the factor by which all volumes are scaled.
TEST(Refinement, the_papers_factor_takes_back_the_volume_that_its_radii_make) {
  for (const auto& [length, made] :
       {std::pair{0.2, 2.866e-2}, {0.4, 2.041e-2}, {0.8, 1.265e-2}}) {
    JetState jet = growing_jet();
    std::ranges::fill(jet.volume, 1.0);
    const double last = link_radius(1, link_length(jet, 40));
    RefinementRule rule = cut(length);
    rule.remap = LinkRemap::paper;
    const auto change = refine_jet(jet, rule);
    ASSERT_TRUE(change);
    const double factor =
        std::pow(link_radius(jet.volume.back(), link_length(jet, jet.links())) / last, 2);
    EXPECT_NEAR(real(40 - change->kept) * (1 / factor - 1) / 40, made, 0.0006e-2);
  }
}

TEST(Refinement, the_papers_mass_and_charge_follow_its_volume) {
  JetState jet = growing_jet();
  RefinementRule rule = cut(0.2);
  rule.remap = LinkRemap::paper;
  const auto change = refine_jet(jet, rule);
  ASSERT_TRUE(change);
  const std::size_t first = change->kept + 1;
  for (std::size_t k = first; k < jet.beads(); ++k) {
    EXPECT_NEAR(jet.mass[k] / jet.volume[k] / (jet.mass[first] / jet.volume[first]), 1,
                1e-14);
    EXPECT_NEAR(jet.charge[k] / jet.volume[k] / (jet.charge[first] / jet.volume[first]), 1,
                1e-14);
  }
}

TEST(Refinement, keeps_wildly_varying_contents_positive) {
  for (const RefinementRule& rule : link_remaps(0.03)) {
    JetState jet = graded_helix(40);
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      jet.volume[k] = std::pow(10, -4 + 4 * std::sin(2.7 * real(k)));
      jet.mass[k] = std::pow(10, -4 + 4 * std::sin(1.9 * real(k)));
    }
    ASSERT_TRUE(refine_jet(jet, rule));
    EXPECT_GT(std::ranges::min(jet.volume), 0) << name(rule);
    EXPECT_GT(std::ranges::min(jet.mass), 0) << name(rule);
    EXPECT_GT(std::ranges::min(jet.charge), 0) << name(rule);
  }
}

// Bead 0 owns no link.
TEST(Refinement, what_bead_zero_carries_plays_no_part) {
  for (const RefinementRule& rule : link_remaps(0.1))
    for (const ColumnRemap stress : {ColumnRemap::spline, ColumnRemap::conservative}) {
      JetState jet = graded_helix(20);
      jet.table = table_with_stress(ColumnRemap::conservative, stress);
      JetState other = jet;
      stress_of(other.columns())[0] = 1e6;
      other.volume[0] = other.mass[0] = other.charge[0] = 1e6;
      const auto change = refine_jet(jet, rule);
      ASSERT_TRUE(change && refine_jet(other, rule));
      EXPECT_EQ(change->kept, 1U); // as close to bead 0 as can be
      for (std::size_t k = 1; k < jet.beads(); ++k) expect_same_bead(jet, k, other, k);
    }
}

// --- momentum and stress ---------------------------------------------------------------------

TEST(Refinement, keeps_momentum_and_makes_no_kinetic_energy_if_asked_to) {
  for (const RefinementRule& rule : link_remaps(0.05)) { // whatever becomes of the masses
    JetState jet = graded_helix(60);
    jet.table = table_with_stress(ColumnRemap::conservative);
    const Sums before(jet);
    ASSERT_TRUE(refine_jet(jet, rule));
    const Sums after(jet);
    EXPECT_LE((after.momentum - before.momentum).norm(), 1e-13 * before.momentum_scale)
        << name(rule);
    EXPECT_LE(after.kinetic, before.kinetic * (1 + 1e-14)) << name(rule);
    EXPECT_GT(after.kinetic, 0.9 * before.kinetic) << name(rule);
  }
}

TEST(Refinement, keeps_volume_times_stress_and_makes_no_elastic_energy_if_asked_to) {
  for (const RefinementRule& rule : link_remaps(0.05)) {
    JetState jet = graded_helix(60);
    jet.table = table_with_stress(ColumnRemap::spline, ColumnRemap::conservative);
    const Sums before(jet);
    ASSERT_TRUE(refine_jet(jet, rule));
    const Sums after(jet);
    EXPECT_NEAR(after.stress / before.stress, 1, 1e-13) << name(rule);
    EXPECT_LE(after.elastic, before.elastic * (1 + 1e-14)) << name(rule);
    EXPECT_GT(after.elastic, 0.9 * before.elastic) << name(rule);
  }
}

// Linear columns are exact, however velocities are moved to the new beads.
TEST(Refinement, a_uniformly_stretching_jet_keeps_stretching_uniformly) {
  JetState jet = growing_jet();
  const double rate = 70, stress = 4321;
  const auto prepare = jet.columns();
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    prepare.velocity().set(k, rate * prepare.position()[k]);
    stress_of(prepare)[k] = stress;
  }
  const double length = along.dot(prepare.position()[40]);
  for (const RefinementRule& rule : link_remaps(0.2)) {
    JetState refined = jet;
    refined.table =
        table_with_stress(ColumnRemap::spline, rule.remap == LinkRemap::conservative
                                                   ? ColumnRemap::conservative
                                                   : ColumnRemap::spline);
    const auto change = refine_jet(refined, rule);
    ASSERT_TRUE(change);
    const auto c = refined.columns();
    const std::size_t s = change->kept;
    const double start = along.dot(c.position()[s]), l = (length - start) / 172;
    for (std::size_t k = s + 1; k < refined.beads(); ++k) {
      const Vec3 place = (start + l * real(k - s)) * along;
      EXPECT_LE((c.position()[k] - place).norm(), 1e-12 * length) << k;
      EXPECT_LE((c.velocity()[k] - rate * place).norm(), 1e-12 * rate * length) << k;
      EXPECT_NEAR(stress_of(c)[k] / stress, 1, 1e-12) << k;
    }
    EXPECT_LE(change->worst_link, 1e-12);
  }
}

// --- the new mesh ----------------------------------------------------------------------------

TEST(Refinement, new_links_are_equal_to_second_order) {
  const auto worst = [](std::size_t links) {
    const JetState old = graded_helix(links);
    JetState jet = old;
    double length = 0;
    for (std::size_t k = 1; k < jet.beads(); ++k) length += link_length(jet, k);
    // From the first link on that is longer than the mean one.
    const auto change = refine_jet(jet, cut(length / real(links)));
    EXPECT_TRUE(change);
    expect_kept_beads(jet, old, change->kept);
    double unequal = 0, first = 0;
    for (std::size_t k = change->kept + 1; k < jet.beads(); ++k) {
      if (first == 0) first = link_length(jet, k);
      unequal = std::max(unequal, std::abs(link_length(jet, k) / first - 1));
    }
    EXPECT_GE(2.01 * change->worst_link, unequal); // either may differ from l*
    return change->worst_link;
  };
  const double coarse = worst(160), fine = worst(1280);
  EXPECT_NEAR(std::log2(coarse / fine) / 3, 2, 0.2);
  EXPECT_LT(fine, 1e-3);
}

TEST(Refinement, reports_its_worst_link) {
  JetState jet = graded_helix(40);
  const double length = [&] {
    double sum = 0;
    for (std::size_t k = 2; k < jet.beads(); ++k) sum += link_length(jet, k);
    return sum;
  }();
  const auto change = refine_jet(jet, cut(0.05)); // from bead 1 on
  ASSERT_TRUE(change);
  ASSERT_EQ(change->kept, 1U);
  const double given = length / real(jet.links() - 1);
  double worst = 0;
  for (std::size_t k = 2; k < jet.beads(); ++k)
    worst = std::max(worst, std::abs(link_length(jet, k) / given - 1));
  EXPECT_GT(worst, 1e-3);
  EXPECT_NEAR(change->worst_link, worst, 1e-12);
}

TEST(Refinement, twice_is_once) {
  for (const RefinementRule& rule : link_remaps(0.2)) {
    JetState jet = growing_jet();
    ASSERT_TRUE(refine_jet(jet, rule));
    const JetState once = jet;
    EXPECT_FALSE(refine_jet(jet, rule)) << name(rule);
    expect_same_jet(jet, once);
  }
}

// Finer chords follow a curve further out: some of the new links come out longer than l*, which may
// be L~ to the last digit. Then a second refinement adds what the first one was short of.
TEST(Refinement, a_curved_jet_may_take_a_second_one_but_no_third) {
  for (const std::size_t links : {20U, 40U, 80U})
    for (const double length : {0.3, 0.2, 0.1, 0.05, 0.02}) {
      JetState jet = graded_helix(links);
      const auto first = refine_jet(jet, cut(length));
      ASSERT_TRUE(first);
      if (const auto second = refine_jet(jet, cut(length))) {
        EXPECT_LE(real(second->after - first->after),
                  first->worst_link * real(first->after) + 1);
        EXPECT_LT(second->worst_link, first->worst_link / 3) << links << ' ' << length;
        const JetState twice = jet;
        EXPECT_FALSE(refine_jet(jet, cut(length))) << links << ' ' << length;
        expect_same_jet(jet, twice);
      }
    }
}

TEST(Refinement, leaves_a_jet_alone_whose_links_are_short_enough) {
  for (const std::size_t links : {0U, 1U, 2U, 15U}) {
    const JetState old = straight_jet(links, 0.2);
    JetState jet = old;
    EXPECT_FALSE(refine_jet(jet, cut(0.2)));
    expect_same_jet(jet, old);
  }
}

TEST(Refinement, cuts_jets_of_few_beads) {
  for (const std::size_t links : {1U, 2U, 3U, 4U, 5U}) {
    const JetState old = straight_jet(links, 1);
    JetState jet = old;
    RefinementRule rule = cut(0.25);
    rule.has_nozzle = false;
    const auto change = refine_jet(jet, rule);
    ASSERT_TRUE(change) << links;
    EXPECT_EQ(change->kept, 0U);
    ASSERT_EQ(jet.links(), 4 * links);
    for (std::size_t k = 0; k < jet.beads(); ++k)
      EXPECT_LE((jet.columns().position()[k] - real(k) / 4 * along).norm(), 1e-14) << k;
    EXPECT_NEAR(Sums(jet).mass / Sums(old).mass, 1, 1e-14);
  }
}

TEST(Refinement, works_without_stresses) {
  JetState with = graded_helix(40), without = with;
  with.table = table_with_stress(ColumnRemap::spline, ColumnRemap::conservative);
  without.y.resize(6 * without.beads()), without.table = BeadTable::basic();
  const RefinementRule rule = cut(0.1);
  ASSERT_TRUE(refine_jet(with, rule));
  ASSERT_TRUE(refine_jet(without, rule));
  with.y.resize(6 * with.beads());
  expect_same_jet(without, with);
}

// --- nozzle, embryo, chain -------------------------------------------------------------------

TEST(Refinement, leaves_the_link_alone_that_is_being_fed) {
  const std::vector<double> links{3, 1, 1};
  const JetState old = straight_jet(links);
  JetState jet = old;
  EXPECT_FALSE(refine_jet(jet, cut(1)));
  expect_same_jet(jet, old);
  const auto change = refine_jet(jet, cut(0.5));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 1U);
  expect_kept_beads(jet, old, 1);
  EXPECT_EQ(jet.links(), 5U);
}

TEST(Refinement, cuts_a_given_chain_from_its_first_bead_on) {
  const std::vector<double> links{3, 1, 1};
  const JetState old = straight_jet(links);
  JetState jet = old;
  RefinementRule rule = cut(1);
  rule.has_nozzle = false;
  const auto change = refine_jet(jet, rule);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 0U);
  expect_kept_beads(jet, old, 0);
  EXPECT_EQ(jet.links(), 5U);
}

// As if the embryo were not there: its place and contents play no part.
TEST(Refinement, passes_an_embryo_by) {
  for (const RefinementRule& rule : link_remaps(0.1)) {
    JetState without = graded_helix(40);
    without.table = table_with_stress(ColumnRemap::conservative, ColumnRemap::conservative);
    JetState with = without;
    insert_bead(with, 1,
                {.position = {5, 6, 7},
                 .velocity = {8, 9, 10},
                 .volume = 12,
                 .mass = 13,
                 .charge = 14,
                 .declared = {11}});
    with.has_embryo = true;
    const JetState old = with;
    const auto change = refine_jet(with, rule), expected = refine_jet(without, rule);
    ASSERT_TRUE(change && expected);
    EXPECT_TRUE(with.has_embryo);
    EXPECT_EQ(change->kept, expected->kept + 1);
    EXPECT_GE(change->kept, 2U);
    EXPECT_EQ(change->worst_link, expected->worst_link);
    expect_kept_beads(with, old, change->kept);
    ASSERT_EQ(with.beads(), without.beads() + 1);
    for (std::size_t k = 1; k < without.beads(); ++k)
      expect_same_bead(with, k + 1, without, k);
  }
}

TEST(Refinement, leaves_the_link_alone_that_is_being_fed_past_an_embryo) {
  const std::vector<double> links{1.5, 1.5, 0.5, 0.5}; // link 1+2 is being fed
  const JetState old = [&] {
    JetState fed = straight_jet(links);
    fed.has_embryo = true;
    return fed;
  }();
  JetState jet = old;
  EXPECT_FALSE(refine_jet(jet, cut(0.5)));
  expect_same_jet(jet, old);
  const auto change = refine_jet(jet, cut(0.25));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->kept, 2U);
  expect_kept_beads(jet, old, 2);
  JetState only = straight_jet(2, 1); // nothing but the fed link
  only.has_embryo = true;
  EXPECT_FALSE(refine_jet(only, cut(0.1)));
}

// --- the collector ---------------------------------------------------------------------------

/// Touches the plane x = 1 thrice on its way; its leading bead has landed there.
JetState landing_jet() {
  JetState jet = jet_through({{0, 0, 0},
                              {0.1, 0.1, 0},
                              {0.3, 0.5, 0.2},
                              {0.7, 1.0, 0.3},
                              {0.98, 1.5, 0.5},
                              {0.99, 2.1, 0.2},
                              {0.9, 2.8, 0.1},
                              {0.995, 3.3, 0.4},
                              {0.985, 3.8, 0.6},
                              {1, 4.5, 0.5}});
  jet.landed = {{.bead = 9, .time = 0.1, .radius = 0.01}};
  jet.absorbing_plane = 1;
  return jet;
}

TEST(Refinement, a_landed_leading_bead_stays_the_last_one_where_and_as_it_is) {
  for (const RefinementRule& base : link_remaps(0.05))
    for (const ColumnRemap velocity : {ColumnRemap::spline, ColumnRemap::conservative})
      for (const ColumnRemap stress : {ColumnRemap::spline, ColumnRemap::conservative}) {
        RefinementRule rule = base;
        rule.collector = 1;
        JetState jet = landing_jet();
        jet.table = table_with_stress(velocity, stress);
        const JetState old = jet;
        ASSERT_TRUE(refine_jet(jet, rule));
        const Bead before = bead_at(old, 9), after = bead_at(jet, jet.links());
        EXPECT_EQ(after.position, before.position);
        EXPECT_EQ(after.velocity, before.velocity);
        EXPECT_EQ(stress_of(after), stress_of(before));
        ASSERT_EQ(jet.landed.size(), 1U);
        EXPECT_EQ(jet.landed[0].bead, jet.links());
        EXPECT_EQ(jet.landed[0].time, 0.1);
        EXPECT_EQ(jet.landed[0].radius, 0.01);
        EXPECT_EQ(jet.time, old.time);
        EXPECT_EQ(jet.absorbing_plane, old.absorbing_plane);
      }
}

TEST(Refinement, a_flying_leading_bead_stays_where_it_is) {
  JetState jet = landing_jet();
  jet.landed.clear();
  const Bead before = bead_at(jet, 9);
  ASSERT_TRUE(refine_jet(jet, cut(0.05)));
  EXPECT_EQ(bead_at(jet, jet.links()).position, before.position);
  EXPECT_EQ(bead_at(jet, jet.links()).velocity, before.velocity);
  EXPECT_EQ(stress_of(bead_at(jet, jet.links())), stress_of(before));
  EXPECT_TRUE(jet.landed.empty());
}

TEST(Refinement, a_landing_record_among_the_kept_beads_stays) {
  JetState jet = straight_jet(std::vector<double>{1, 1, 1, 1, 5, 5});
  jet.landed = {{.bead = 2, .time = 1, .radius = 2}, {.bead = 6, .time = 3, .radius = 4}};
  ASSERT_TRUE(refine_jet(jet, cut(1)));
  ASSERT_EQ(jet.links(), 14U);
  ASSERT_EQ(jet.landed.size(), 2U);
  EXPECT_EQ(jet.landed[0].bead, 2U);
  EXPECT_EQ(jet.landed[0].time, 1);
  EXPECT_EQ(jet.landed[0].radius, 2);
  EXPECT_EQ(jet.landed[1].bead, 14U);
}

TEST(Refinement, puts_no_new_bead_beyond_the_collector) {
  JetState open = landing_jet(), closed = open;
  RefinementRule rule = cut(0.02);
  ASSERT_TRUE(refine_jet(open, rule));
  rule.collector = 1;
  ASSERT_TRUE(refine_jet(closed, rule));
  ASSERT_EQ(open.beads(), closed.beads());
  std::size_t beyond = 0;
  const auto x = open.columns().position().x, held = closed.columns().position().x;
  for (std::size_t k = 0; k < open.beads(); ++k) {
    if (x[k] > 1) ++beyond;
    EXPECT_EQ(held[k], std::min(x[k], 1.0)) << k;
  }
  EXPECT_GT(beyond, 0U);
  for (std::size_t c = 1; c < 7; ++c)
    EXPECT_TRUE(std::ranges::equal(open.columns().column(c), closed.columns().column(c)));
}

} // namespace
} // namespace ehdjet
