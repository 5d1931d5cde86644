#include "ehdjet/scene/stability.hpp"

#include <cmath>
#include <limits>

#include "support.hpp"

namespace ehdjet {
namespace {

/// The PVP fluid with Coulomb force, surface tension and a Maxwell fluid G, mu.
SceneConfig fluid(double G, double mu) {
  SceneConfig c = read_scene(EHDJET_SCENES "/pvp.toml").config;
  c.viscoelasticity = {.elastic_modulus = G, .viscosity = mu};
  return c;
}
LinkState link(double length, double radius) {
  return {length, radius, 839.253525, 14.67682018871869};
}
const LinkState at_nozzle = link(2e-4, 5e-5);

constexpr double printed = 0.005; // three digits

TEST(Stability, rates_at_the_nozzle_are_those_of_the_linearised_chain) {
  const ChainRates r = chain_rates(fluid(5e3, 2), at_nozzle);
  EXPECT_NEAR(*r.relaxation, 2.5e3, 1e-9);
  EXPECT_NEAR(*r.elastic, 24408.3496, 1e-4);
  EXPECT_NEAR(*r.viscous, 238307.0, 0.1);
  const double gamma = 21282.421221334;
  EXPECT_NEAR(*r.coulomb / gamma, 2.901, 5e-4);
  EXPECT_NEAR(*r.coulomb_growth / gamma, 2.051, 5e-4);
  EXPECT_NEAR(*r.surface_tension, 3548.289, 1e-3);
}

struct Row {
  double G, mu;
  LinkState link;
  double longest_step;
};

// Computed independently of this code from the same linearisation.
TEST(Stability, longest_steps_are_those_of_an_independent_table) {
  const Row rows[] = {
      {5e3, 2, at_nozzle, 4.58e-5},               // Coulomb
      {5e3, 2, link(2e-3, 7.9e-5 / 10), 1.07e-3}, // refined
      {5e4, 2, at_nozzle, 3.76e-5},               // elastic
      {1, 1e-3, at_nozzle, 4.58e-5},
      {5e4, 1e-3, at_nozzle, 5.57e-8}, // relaxation
      {1e9, 1e-3, at_nozzle, 2.8e-12},
      {1e9, 2, at_nozzle, 5.6e-9}, // Newtonian
      {5e4, 1e4, at_nozzle, 3.66e-5},
      {1, 1e4, at_nozzle, 4.58e-5},
      {1e9, 1e4, at_nozzle, 2.6e-7},         // solid
      {5e3, 2, link(1e-8, 2.5e-9), 2.8e-10}, // surface tension
      {1e9, 1e4, link(1e-8, 2.5e-9), 1.3e-11},
  };
  for (const Row& row : rows) {
    const double dt = step_limits(chain_rates(fluid(row.G, row.mu), row.link)).least();
    EXPECT_NEAR(dt / row.longest_step, 1, 0.02) << "G " << row.G << " mu " << row.mu;
  }
}

TEST(Stability, a_refined_link_is_as_slow_as_the_table_says) {
  const ChainRates r = chain_rates(fluid(5e3, 2), link(2e-3, 7.9e-6));
  EXPECT_NEAR(*r.elastic / 2.44e3, 1, printed);
  EXPECT_NEAR(*r.viscous / 2.38e3, 1, printed);
  EXPECT_NEAR(*r.coulomb / 976, 1, printed);
  EXPECT_NEAR(*r.surface_tension / 112, 1, printed);
}

TEST(Stability, line_tension_is_the_slender_form_of_surface_tension) {
  SceneConfig c = fluid(5e3, 2);
  c.surface_tension->form = SurfaceTensionForm::line;
  const double expected = 2 * std::sqrt(0.021133 / (839.253525 * 5e-5)) / 2e-4;
  EXPECT_NEAR(*chain_rates(c, at_nozzle).surface_tension / expected, 1, 1e-14);
}

TEST(Stability, a_term_that_is_absent_or_idle_limits_nothing) {
  SceneConfig none;
  EXPECT_EQ(step_limits(chain_rates(none, at_nozzle)).least(),
            std::numeric_limits<double>::infinity());
  SceneConfig idle = fluid(0, 2);
  idle.surface_tension->coefficient = 0;
  LinkState uncharged = at_nozzle;
  uncharged.charge_density = 0;
  const StabilityLimits limits = step_limits(chain_rates(idle, uncharged));
  EXPECT_FALSE(limits.viscoelastic);
  EXPECT_EQ(limits.least(), std::numeric_limits<double>::infinity());
}

TEST(Stability, a_vanishing_viscosity_needs_vanishing_steps_and_no_overflow) {
  EXPECT_NEAR(step_limits(chain_rates(fluid(1, 1e-200), at_nozzle)).least() / 2.785e-200, 1,
              1e-3);
  EXPECT_EQ(step_limits(chain_rates(fluid(1e12, 1e-300), at_nozzle)).least(), 0);
}

TEST(Stability, the_stiffest_link_of_a_chain_is_a_short_one) {
  Scene s = read_scene(EHDJET_SCENES "/chain.toml");
  s.chain.x[3] = s.chain.x[2] + 1e-5;
  s.chain.y[3] = s.chain.y[2], s.chain.z[3] = s.chain.z[2];
  EXPECT_EQ(stiffest_link(s), 3u);
  EXPECT_NEAR(link_state(s, 3).length, 1e-5, 1e-18);
  EXPECT_NEAR(link_state(s, 3).density, 839.253525, 1e-9);
  EXPECT_EQ(stiffest_link(read_scene(EHDJET_SCENES "/pvp.toml")), 1u);
}

} // namespace
} // namespace ehdjet
