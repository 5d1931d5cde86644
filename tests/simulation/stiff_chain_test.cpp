#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double duration = 1e-4; // [s]

/// The golden chain, held at bead 0, of another fluid. SI units.
Scene chain_of(double modulus, double viscosity) {
  Scene scene = GoldenChain("held").scene;
  scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
  return scene;
}

JetState after_fixed_steps(Scene scene, const std::string& method, double step) {
  integrate_with_fixed_steps(scene, method, step);
  return run(scene, duration)->jet();
}

/// |r - r_exact|_2 over the chain in link lengths.
double distance(const JetState& jet, const JetState& exact) {
  double squares = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k)
    squares += (jet.columns().position()[k] - exact.columns().position()[k]).squaredNorm();
  return std::sqrt(squares) / pvp::link_length;
}

struct Fluid {
  const char* name;
  double modulus, viscosity; // [Pa], [Pa s]
  double explicit_step;      // at which an explicit method is stable, for a reference [s]
};
std::ostream& operator<<(std::ostream& os, const Fluid& f) {
  return os << f.name;
}
constexpr Fluid pvp_fluid{"pvp", 5e3, 2, 2.5e-7};
constexpr Fluid newtonian{"newtonian", 1e9, 2, 4e-9}; // relaxes in 2 ns
constexpr Fluid thin{"thin", 5e4, 1e-3, 4e-8};        // and in 20 ns
constexpr Fluid solid{"solid", 1e9, 1e4, 2e-8};       // rings at 1.1e7 1/s

JetState exact_motion(const Fluid& f) {
  return after_fixed_steps(chain_of(f.modulus, f.viscosity), "dormand-prince",
                           f.explicit_step);
}

struct Published {
  Fluid fluid;
  double step, error;
};

// Computed independently: another implementation, whose Jacobian are differences of the right-hand
// side without Coulomb force.
TEST(StiffChain, errors_of_ros34pw2_are_those_found_elsewhere) {
  const Published rows[] = {{pvp_fluid, 1e-5, 1.20e-3}, {pvp_fluid, 2.5e-6, 2.28e-5},
                            {newtonian, 1e-5, 7.03e-4}, {newtonian, 1.25e-6, 1.63e-6},
                            {thin, 1e-5, 1.21e-3},      {thin, 1.25e-6, 2.94e-6},
                            {solid, 1e-5, 1.2e-3},      {solid, 5e-6, 6.6e-5},
                            {solid, 1.25e-6, 2.0e-5}};
  for (const auto& [fluid, step, error] : rows) {
    const Scene scene = chain_of(fluid.modulus, fluid.viscosity);
    EXPECT_NEAR(distance(after_fixed_steps(scene, "ros34pw2", step), exact_motion(fluid))
                    / error,
                1, 0.03)
        << fluid << " " << step;
  }
}

TEST(StiffChain, ros34pw2_keeps_its_order_however_fast_stress_relaxes) {
  for (const Fluid& fluid : {pvp_fluid, newtonian, thin}) {
    const JetState exact = exact_motion(fluid);
    std::vector<double> steps, errors;
    for (const double step : {5e-6, 2.5e-6, 1.25e-6, 6.25e-7}) {
      steps.push_back(step);
      errors.push_back(distance(
          after_fixed_steps(chain_of(fluid.modulus, fluid.viscosity), "ros34pw2", step),
          exact));
    }
    EXPECT_NEAR(observed_order(steps, errors), 3, 0.1) << fluid;
  }
}

// sigma -> mu l'/l with an error O(tau): the motion settles as G grows at constant mu.
TEST(StiffChain, becomes_newtonian_as_relaxation_becomes_instant) {
  const auto end = [](double modulus) {
    return after_fixed_steps(chain_of(modulus, 2), "ros34pw2", 1e-6);
  };
  std::vector<JetState> jets;
  for (double modulus = 1e7; modulus < 3e12; modulus *= 10) jets.push_back(end(modulus));
  for (std::size_t i = 2; i < jets.size(); ++i)
    EXPECT_NEAR(distance(jets[i - 1], jets[i]) / distance(jets[i - 2], jets[i - 1]), 0.1,
                0.01)
        << i;

  const JetState& newtonian_jet = jets.back();
  const auto c = newtonian_jet.columns();
  for (std::size_t k = 1; k < newtonian_jet.beads(); ++k) {
    const Vec3 d = c.position()[k] - c.position()[k - 1];
    const double strain_rate =
        (c.velocity()[k] - c.velocity()[k - 1]).dot(d) / d.squaredNorm();
    EXPECT_NEAR(stress_of(c)[k], 2 * strain_rate, 1e-4 * 2 * std::abs(strain_rate) + 1e-3)
        << k;
  }
}

// Elastic waves that a step of a hundred of their radians cannot resolve are damped, and what is
// left is the motion they ride on.
TEST(StiffChain, a_solid_filament_is_stable_at_forty_times_the_explicit_limit) {
  const JetState exact = exact_motion(solid);
  const JetState jet =
      after_fixed_steps(chain_of(solid.modulus, solid.viscosity), "ros34pw2", 5e-6);
  EXPECT_LE(distance(jet, exact), 1e-4);
  double difference = 0, strongest = 0;
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    const double stress = stress_of(exact.columns())[k];
    difference = std::max(difference, std::abs(stress_of(jet.columns())[k] - stress));
    strongest = std::max(strongest, std::abs(stress));
  }
  EXPECT_LE(difference, 0.02 * strongest);

  // Without field and charges a plucked filament comes to rest.
  Scene scene = chain_of(solid.modulus, solid.viscosity);
  scene.config.coulomb.reset(), scene.config.field.reset();
  scene.config.surface_tension.reset();
  for (std::size_t k = 1; k < scene.chain.size(); ++k)
    stresses(scene.chain)[k] = k % 2 == 0 ? 1e3 : -1e3;
  integrate_with_fixed_steps(scene, "ros34pw2", 5e-6);
  const auto energy = [&](const JetState& j) {
    double sum = 0;
    for (std::size_t k = 1; k < j.beads(); ++k)
      sum += j.mass[k] * j.columns().velocity()[k].squaredNorm() / 2
             + j.volume[k] * std::pow(stress_of(j.columns())[k], 2) / (2 * solid.modulus);
    return sum;
  };
  const double start = energy(initial_jet(scene));
  double before = start;
  auto simulation = build_simulation(scene);
  simulation->after_each_step([&](const Simulation& s) {
    const double now = energy(s.jet());
    EXPECT_LE(now, before * (1 + 1e-9)) << s.jet().time;
    before = now;
  });
  simulation->run_until(20 * duration);
  EXPECT_LE(before, 0.1 * start);
}

struct Budget {
  Fluid fluid;
  double rtol;
  std::uint64_t evaluations;
};

TEST(StiffChain, an_error_of_1e_4_link_lengths_costs_few_evaluations) {
  for (const std::string method : {"ros34pw2", "auto"})
    for (const auto& [fluid, rtol, evaluations] :
         {Budget{newtonian, 1e-4, 150}, {thin, 1e-4, 150}, {solid, 1e-4, 1000}}) {
      Scene scene = chain_of(fluid.modulus, fluid.viscosity);
      integrate(scene, method, rtol);
      const auto simulation = run(scene, duration);
      EXPECT_LE(distance(simulation->jet(), exact_motion(fluid)), 1e-4)
          << method << " " << fluid;
      EXPECT_LE(simulation->statistics().evaluations, evaluations)
          << method << " " << fluid;
    }
}

TEST(StiffChain, errors_fall_with_the_tolerance) {
  for (const Fluid& fluid : {newtonian, thin, solid}) {
    const JetState exact = exact_motion(fluid);
    double before = 1;
    for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      Scene scene = chain_of(fluid.modulus, fluid.viscosity);
      integrate(scene, "ros34pw2", rtol);
      const double error = distance(run(scene, duration)->jet(), exact);
      EXPECT_LE(error, before / 3) << fluid << " " << rtol;
      before = error;
    }
    EXPECT_LE(before, 1e-7) << fluid;
  }
}

} // namespace
} // namespace ehdjet
