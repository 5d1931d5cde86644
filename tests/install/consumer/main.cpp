// Somebody else's program: two equal charges, joined by a viscoelastic link, push each other
// apart. Composed by hand from the public headers, without a scene file.
#include "ehdjet/core/version.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/forces/coulomb_force.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

using namespace ehdjet;

int main() {
  JetState jet;
  jet.mass = {1e-9, 1e-9};     // [kg]
  jet.charge = {1e-11, 1e-11}; // [C]
  jet.volume = {1e-12, 1e-12}; // [m^3]
  jet.y.assign(14, 0.0);       // two beads at rest, six columns and the stress
  jet.columns().position().set(1, {1e-3, 0, 0});

  auto dynamics = std::make_unique<JetDynamics>();
  dynamics->add(std::make_unique<CoulombForce>(make_direct_sum()));
  dynamics->add(std::make_unique<Maxwell>(5e3, 2.0));
  auto table = std::make_shared<BeadTable>();
  for (const auto& term : dynamics->terms())
    for (const BeadColumn& column : term->columns()) table->declare(column);
  jet.table = table;

  ErrorScale scale{.rtol = 1e-8, .column_scale = {1e-3, 1e-3, 1e-3, 1, 1, 1, 500}};
  auto integrator = std::make_unique<RungeKutta>(butcher_tableau("dormand-prince"), scale);
  Simulation simulation(std::move(jet), std::move(dynamics), std::move(integrator),
                        StepLimits{});
  simulation.run_until(1e-4);

  const auto columns = simulation.jet().columns();
  const Vec3 r0 = columns.position()[0], r1 = columns.position()[1];
  std::printf("ehdjet %s: %g s, distance %g m, stress %g Pa\n", version::number,
              simulation.jet().time, (r1 - r0).norm(), columns.column(6)[1]);

  const bool on_time = simulation.jet().time == 1e-4;
  const bool centre_at_rest = std::abs(r0.x() + r1.x() - 1e-3) < 1e-15;
  const bool apart = (r1 - r0).norm() > 1.005e-3, taut = columns.column(6)[1] > 0;
  return on_time && centre_at_rest && apart && taut ? 0 : 1;
}
