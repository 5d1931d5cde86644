#include "ehdjet/scene/dimensionless.hpp"

#include <cmath>

#include "support.hpp"

namespace ehdjet {
namespace {

SceneConfig pvp() {
  return read_scene(EHDJET_SCENES "/pvp.toml").config;
}

/// The printed value has ten digits.
void expect_printed(std::optional<double> value, double printed) {
  ASSERT_TRUE(value);
  EXPECT_NEAR(*value / printed, 1, 5e-10);
}

// What JETSPIN prints for this jet, from the same input in cgs units.
TEST(DimensionlessGroups, of_the_pvp_jet_are_those_of_the_reference_code) {
  const auto g = dimensionless_groups(pvp());
  ASSERT_TRUE(g);
  expect_printed(g->length, 3.487728022e-4);
  expect_printed(g->time, 4e-4);
  expect_printed(g->coulomb, 13.66545847);
  expect_printed(g->viscoelastic, 13.66545847);
  expect_printed(g->viscoelastic_jetspin, 211.6506208);
  expect_printed(g->field, 0.4512723227);
  expect_printed(g->surface_tension, 0.1656047329);
  expect_printed(g->collector, 458.7513676);
  expect_printed(g->gravity, 4.498814099e-3);
  expect_printed(g->nozzle_motion, 4); // omega tau = 1e4/s 0.4 ms
}

// The start-up example of JETSPIN: rho 0.818912288 g/cm^3, rho_q 3761.26389 statC/cm^3,
// a0 0.015 cm, l 0.319 cm, mu 100 P, G 1e4 dyn/cm^2, 277.8141 statV over 200 cm.
TEST(DimensionlessGroups, of_the_start_up_example_are_twelve_and_two) {
  SceneConfig c;
  c.nozzle = NozzleConfig{.radius = 1.5e-4,
                          .link_length = 3.19e-3,
                          .density = 818.912288,
                          .charge_density = 3761.26389 / 2.99792458e3};
  c.viscoelasticity = {.elastic_modulus = 1e3, .viscosity = 10};
  c.collector = {.distance = 2};
  c.field = FieldConfig{.potential = 277.8141 * 299.792458, .strength = {}};
  const auto g = dimensionless_groups(c);
  expect_printed(g->coulomb, 12.00000000);
  expect_printed(g->viscoelastic, 12.00000000);
  expect_printed(g->field, 2.00000012);
  expect_printed(g->length, 3.19e-3);
}

// Time unchanged: l, a, A, g, h, v_s -> s; G, mu -> s^2; alpha -> s^3; Phi0/h -> s.
TEST(DimensionlessGroups, do_not_change_under_similarity) {
  const double s = 0.37;
  SceneConfig c = pvp();
  const auto before = dimensionless_groups(c);
  for (double* length :
       {&c.nozzle->radius, &c.nozzle->link_length, &c.nozzle->amplitude,
        &*c.nozzle->velocity, &c.collector->distance, &c.gravity->acceleration})
    *length *= s;
  *c.viscoelasticity->elastic_modulus *= s * s;
  *c.viscoelasticity->viscosity *= s * s;
  c.surface_tension->coefficient *= s * s * s;
  *c.field->potential *= s * s;
  const auto after = dimensionless_groups(c);
  const double round_off = 1e-14;
  EXPECT_NEAR(after->coulomb / before->coulomb, 1, round_off);
  EXPECT_NEAR(*after->field / *before->field, 1, round_off);
  EXPECT_NEAR(*after->surface_tension / *before->surface_tension, 1, round_off);
  EXPECT_NEAR(*after->collector / *before->collector, 1, round_off);
  EXPECT_NEAR(*after->gravity / *before->gravity, 1, round_off);
}

TEST(DimensionlessGroups, of_an_absent_term_are_absent) {
  SceneConfig c = pvp();
  c.field.reset(), c.gravity.reset(), c.surface_tension.reset(), c.collector.reset();
  const auto g = dimensionless_groups(c);
  EXPECT_FALSE(g->field || g->gravity || g->surface_tension || g->collector);
  c.viscoelasticity->viscosity = 0;
  EXPECT_FALSE(dimensionless_groups(c));
}

} // namespace
} // namespace ehdjet
