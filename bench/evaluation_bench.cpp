// Cost of one evaluation of the right-hand side on a real jet: the PVP scene at t = 20 ms, 150
// beads. `everything_else` is the same jet without the Coulomb term; the quotient of the two rows
// is what the local terms cost. `step` is a whole Dormand-Prince step, bookkeeping included.
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <benchmark/benchmark.h>
#include <omp.h>

namespace {

using namespace ehdjet;

const JetState& whipping_jet() {
  static const JetState jet = [] {
    const auto simulation = build_simulation(read_scene(EHDJET_SCENES "/pvp.toml"));
    simulation->run_until(0.02);
    return simulation->jet();
  }();
  return jet;
}

// The terms of the PVP scene, with or without the Coulomb force, bound to the jet.
std::unique_ptr<JetDynamics> dynamics(bool with_coulomb) {
  Scene scene = read_scene(EHDJET_SCENES "/pvp.toml");
  if (!with_coulomb) scene.config.coulomb.reset();
  auto d = build_dynamics(scene);
  d->bind(whipping_jet());
  return d;
}

void evaluate(benchmark::State& state, bool with_coulomb) {
  omp_set_num_threads(1);
  const auto d = dynamics(with_coulomb);
  std::vector<double> y = whipping_jet().y, rate(y.size());
  for (auto _ : state) {
    d->evaluate(whipping_jet().time, y, rate);
    benchmark::DoNotOptimize(rate.data());
  }
  state.counters["beads"] = static_cast<double>(whipping_jet().beads());
}
BENCHMARK_CAPTURE(evaluate, everything, true);
BENCHMARK_CAPTURE(evaluate, everything_else, false);

void coulomb_force(benchmark::State& state) {
  omp_set_num_threads(1);
  const auto solver = make_coulomb_solver({.solver = "direct"});
  const JetState& jet = whipping_jet();
  std::vector<double> f(3 * jet.beads());
  const std::span<double> all(f);
  const std::size_t n = jet.beads();
  for (auto _ : state) {
    solver->add_force({jet.columns().position(), jet.charge},
                      {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)});
    benchmark::DoNotOptimize(f.data());
  }
}
BENCHMARK(coulomb_force);

// One attempted step of a method, divided by its evaluations: what an evaluation costs in a run.
void step(benchmark::State& state, const char* method) {
  omp_set_num_threads(1);
  const auto d = dynamics(true);
  const JetState& jet = whipping_jet();
  std::vector<double> y = jet.y;
  RungeKutta integrator(butcher_tableau(method),
                        {.rtol = 1e-6, .column_scale = {2e-4, 2e-4, 2e-4, 1, 1, 1, 500}});
  const std::uint64_t before = d->evaluations();
  for (auto _ : state) benchmark::DoNotOptimize(integrator.attempt(*d, jet.time, 1e-6, y));
  state.counters["per_evaluation"] =
      benchmark::Counter(static_cast<double>(d->evaluations() - before),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(step, dormand_prince, "dormand-prince");
BENCHMARK_CAPTURE(step, dop853, "dop853");

} // namespace

BENCHMARK_MAIN();
