#include "ehdjet/events/insertion.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double l = pvp::link_length;
const Nozzle nozzle{.fluid_velocity = pvp::velocity,
                    .amplitude = 1e-5,
                    .angular_frequency = 1e4,
                    .phase = 0.3};
const LinkContent born =
    LinkContent::of_cylinder(pvp::radius, l, pvp::density, pvp::charge_density);
const EmbryoInflow inflow(nozzle, {.link_length = l, .born = born});

/// The nozzle's jet with its first bead at `distance` from the nozzle, moving and stressed.
JetState jet_at(double distance) {
  JetState jet = initial_jet(case_one());
  const auto c = jet.columns();
  c.position().set(0, nozzle.position(0));
  c.position().set(1, nozzle.position(0) + distance * Vec3(2. / 3, 1. / 3, -2. / 3));
  c.velocity().set(1, {5, 0.3, -0.2});
  stress_of(c)[1] = 4321;
  jet.volume[1] *= 1.1;
  return jet;
}

struct Books {
  Ledger ledger;
  RunStatistics statistics;
  std::vector<DepositedBead> deposited;
  std::vector<RefinementRecord> refined;
  EventContext with(JetState& jet) { return {jet, ledger, statistics, deposited, refined}; }
};

TEST(LinkContent, carries_what_a_cylinder_of_one_link_holds) {
  EXPECT_NEAR(born.volume / (1.570796326794897e-6 * cm3), 1, 4 * epsilon);
  EXPECT_NEAR(born.mass / (1.318296354319669e-6 * gram), 1, 4 * epsilon);
  EXPECT_NEAR(born.charge / (6.911503837897547e-2 * statC), 1, 4 * epsilon);
}

TEST(Insertion, is_due_from_one_and_a_half_links_on_unless_an_embryo_is_there) {
  const Insertion insertion(inflow);
  const double beyond = 1 + 8 * epsilon;
  EXPECT_FALSE(insertion.due(jet_at(1.5 * l / beyond)));
  EXPECT_TRUE(insertion.due(jet_at(1.5 * l * beyond)));
  JetState jet = jet_at(1.7 * l);
  jet.has_embryo = true;
  EXPECT_FALSE(insertion.due(jet));
  jet.has_embryo = false;
  jet.landed = {{.bead = 1, .time = 0, .radius = 0}};
  EXPECT_FALSE(insertion.due(jet)) << "behind a landed bead";
}

TEST(Insertion, makes_an_embryo_and_leaves_the_other_beads_as_they_are) {
  Insertion insertion(inflow);
  JetState jet = jet_at(1.5 * l);
  const Bead before = bead_at(jet, 1);
  Books books;
  EventContext context = books.with(jet);
  insertion.apply(context);
  ASSERT_EQ(jet.beads(), 3U);
  EXPECT_TRUE(jet.has_embryo);
  const Bead after = bead_at(jet, 2), made = bead_at(jet, 1);
  EXPECT_EQ(after.position, before.position);
  EXPECT_EQ(after.velocity, before.velocity);
  EXPECT_EQ(stress_of(after), stress_of(before));
  EXPECT_EQ(after.volume, before.volume);
  const Vec3 from = nozzle.position(0);
  EXPECT_NEAR((made.position - from).norm() / l, 1, 8 * epsilon);
  EXPECT_LE((made.position - from).cross(before.position - from).norm(),
            16 * epsilon * l * l);
  EXPECT_EQ(made.velocity, Vec3(pvp::velocity, 0, 0));
  EXPECT_EQ(stress_of(made), 0);
  EXPECT_EQ(made.mass, born.mass);
  EXPECT_EQ(made.charge, born.charge) << "its share acts in the Coulomb sum alone";
  EXPECT_EQ(made.volume, born.volume);
  EXPECT_EQ(books.ledger.inserted_beads, 1U);
  EXPECT_EQ(double(books.ledger.inserted_mass), born.mass);
  EXPECT_EQ(double(books.ledger.inserted_charge), born.charge);
  EXPECT_EQ(double(books.ledger.inserted_volume), born.volume);
  EXPECT_EQ(books.statistics.insertions, 1U);
}

TEST(Release, is_due_from_two_links_on_if_there_is_an_embryo) {
  const Release release(inflow);
  for (const double distance : {1.99 * l, 2.01 * l}) {
    JetState jet = jet_at(distance);
    EXPECT_FALSE(release.due(jet));
    Insertion insertion(inflow);
    Books books;
    EventContext context = books.with(jet);
    insertion.apply(context);
    EXPECT_EQ(release.due(jet), distance > 2 * l);
  }
}

TEST(Release, frees_the_embryo_with_half_the_velocity_of_its_neighbour_or_the_nozzles) {
  const double vs = pvp::velocity;
  // ((v_x - v_s)/2 + v_s, v_y/2, v_z/2)
  const Vec3 half((5 - vs) / 2 + vs, 0.15, -0.1), slow(vs, 0, 0);
  for (const auto& [choice, expected] :
       {std::pair{ReleaseVelocity::half, half}, {ReleaseVelocity::nozzle, slow}}) {
    JetState jet = jet_at(2 * l);
    Books books;
    EventContext context = books.with(jet);
    Insertion(inflow).apply(context);
    const Bead before = bead_at(jet, 2);
    const EmbryoInflow chosen(nozzle, {.link_length = l, .born = born, .release = choice});
    Release(chosen).apply(context);
    EXPECT_FALSE(jet.has_embryo);
    ASSERT_EQ(jet.beads(), 3U);
    const Bead freed = bead_at(jet, 1), neighbour = bead_at(jet, 2);
    EXPECT_LE((freed.velocity - expected).norm(), 4 * epsilon * expected.norm());
    EXPECT_EQ(stress_of(freed), 0);
    EXPECT_EQ(freed.charge, born.charge);
    EXPECT_NEAR(books.ledger.release_speed / expected.norm(), 1, 4 * epsilon);
    EXPECT_EQ(books.statistics.releases, 1U);
    // Bead 2 keeps its stress and volume while its link shrinks from two links to one.
    EXPECT_EQ(stress_of(neighbour), stress_of(before));
    EXPECT_EQ(neighbour.volume, before.volume);
    EXPECT_EQ(neighbour.velocity, before.velocity);
    EXPECT_NEAR(link_length(jet, 2) / l, 1, 16 * epsilon);
  }
}

} // namespace
} // namespace ehdjet
