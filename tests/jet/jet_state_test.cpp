#include "ehdjet/core/error.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/stress.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// A bead all of whose values are different and tell which bead it is.
Bead numbered(double k) {
  return {.position = {k + 0.1, k + 0.2, k + 0.3},
          .velocity = {k + 0.4, k + 0.5, k + 0.6},
          .volume = k + 0.8,
          .mass = k + 0.9,
          .charge = k + 0.95,
          .declared = {k + 0.7}};
}

void expect_bead(const JetState& jet, std::size_t at, const Bead& expected) {
  const Bead b = bead_at(jet, at);
  EXPECT_EQ(b.position, expected.position) << at;
  EXPECT_EQ(b.velocity, expected.velocity) << at;
  EXPECT_EQ(b.declared, expected.declared) << at;
  EXPECT_EQ(b.volume, expected.volume) << at;
  EXPECT_EQ(b.mass, expected.mass) << at;
  EXPECT_EQ(b.charge, expected.charge) << at;
}

/// Beads numbered 0 ... n-1, built at their far end.
JetState chain(std::size_t n, bool with_stress = true) {
  JetState jet = blank_jet(with_stress ? table_with_stress() : BeadTable::basic(), 0);
  for (std::size_t k = 0; k < n; ++k) {
    Bead bead = numbered(static_cast<double>(k));
    if (!with_stress) bead.declared.clear();
    insert_bead(jet, k, bead);
  }
  return jet;
}

TEST(JetState, insertion_at_any_place_keeps_every_column_of_every_bead) {
  constexpr std::size_t n = 5;
  for (std::size_t at = 0; at <= n; ++at) {
    JetState jet = chain(n);
    insert_bead(jet, at, numbered(100));
    ASSERT_EQ(jet.beads(), n + 1);
    ASSERT_EQ(jet.y.size(), 7 * (n + 1));
    for (std::size_t k = 0; k < at; ++k)
      expect_bead(jet, k, numbered(static_cast<double>(k)));
    expect_bead(jet, at, numbered(100));
    for (std::size_t k = at; k < n; ++k)
      expect_bead(jet, k + 1, numbered(static_cast<double>(k)));
  }
}

TEST(JetState, insertion_moves_the_landing_records_of_later_beads_up) {
  JetState jet = chain(5);
  jet.landed = {{.bead = 2, .time = 1, .radius = 2}, {.bead = 4, .time = 3, .radius = 4}};
  insert_bead(jet, 3, numbered(100));
  ASSERT_EQ(jet.landed.size(), 2U);
  EXPECT_EQ(jet.landed[0].bead, 2U);
  EXPECT_EQ(jet.landed[1].bead, 5U);
  EXPECT_EQ(jet.landed[1].time, 3);
  EXPECT_TRUE(jet.is_landed(2) && jet.is_landed(5));
  EXPECT_FALSE(jet.is_landed(3) || jet.is_landed(4));
}

TEST(JetState, removal_of_the_leading_bead_keeps_the_others_and_drops_its_landing_record) {
  JetState jet = chain(5);
  jet.landed = {{.bead = 2, .time = 1, .radius = 2}, {.bead = 4, .time = 3, .radius = 4}};
  remove_leading_bead(jet);
  ASSERT_EQ(jet.beads(), 4U);
  ASSERT_EQ(jet.y.size(), 28U);
  for (std::size_t k = 0; k < 4; ++k) expect_bead(jet, k, numbered(static_cast<double>(k)));
  ASSERT_EQ(jet.landed.size(), 1U);
  EXPECT_EQ(jet.landed[0].bead, 2U);
  remove_leading_bead(jet); // one that has not landed
  ASSERT_EQ(jet.landed.size(), 1U);
  for (std::size_t k = 0; k < 3; ++k) expect_bead(jet, k, numbered(static_cast<double>(k)));
}

TEST(JetState, a_chain_without_viscoelasticity_stores_no_stress) {
  JetState jet = chain(4, false);
  Bead without = numbered(100);
  EXPECT_THROW(insert_bead(jet, 1, without), ContractViolation);
  without.declared.clear();
  insert_bead(jet, 1, without);
  remove_leading_bead(jet);
  EXPECT_EQ(jet.y.size(), 6 * jet.beads());
  EXPECT_FALSE(has_stress(jet.columns()));
  expect_bead(jet, 1, without);
}

TEST(JetState, the_upstream_neighbour_behind_an_embryo_is_bead_zero) {
  JetState jet = chain(5);
  const auto r = jet.columns().position();
  for (std::size_t k = 1; k < 5; ++k)
    r.set(k, Vec3(1. / 3, 2. / 3, -2. / 3) * std::pow(2, k));
  r.set(0, Vec3::Zero());
  const double round_off = 1e-15; // of numbers of order 10
  EXPECT_NEAR(link_length(jet, 1), 2, round_off);
  EXPECT_NEAR(link_length(jet, 2), 2, round_off);
  jet.has_embryo = true;
  EXPECT_EQ(jet.first(), 2U);
  EXPECT_NEAR(link_length(jet, 2), 4, 2 * round_off);
  EXPECT_NEAR(link_length(jet, 3), 4, 2 * round_off);
}

TEST(JetState, a_link_is_a_cylinder_of_its_volume) {
  const double a = link_radius(3e-12, 0.7);
  EXPECT_NEAR(std::numbers::pi * a * a * 0.7 / 3e-12, 1, 1e-15);
}

TEST(JetState, impossible_places_are_contract_violations) {
  JetState jet = chain(3);
  EXPECT_THROW(insert_bead(jet, 4, numbered(9)), ContractViolation);
  EXPECT_THROW((void)link_length(jet, 0), ContractViolation);
  EXPECT_THROW((void)link_length(jet, 3), ContractViolation);
  JetState single = chain(1);
  EXPECT_THROW(remove_leading_bead(single), ContractViolation);
}

} // namespace
} // namespace ehdjet
