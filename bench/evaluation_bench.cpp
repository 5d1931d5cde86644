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

#include <cmath>

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

// --- long jets: range(0) beads on range(1) threads

/// A helix of links of 0.2 mm with the beads of the PVP jet.
JetState long_jet(std::size_t beads) {
  JetState jet = blank_jet(whipping_jet().table, beads);
  const Bead bead = bead_at(whipping_jet(), 100);
  constexpr double link = 2e-4, radius = 0.02,
                   rise = 0.03; // [m], [m], axial part of a link
  for (std::size_t k = 0; k < beads; ++k) {
    const double s = link * static_cast<double>(k), angle = s / radius;
    jet.columns().position().set(
        k, {rise * s, radius * std::cos(angle), radius * std::sin(angle)});
    jet.columns().velocity().set(k, bead.velocity);
    jet.mass[k] = bead.mass, jet.charge[k] = bead.charge, jet.volume[k] = bead.volume;
  }
  return jet;
}

struct LongJet {
  LongJet(benchmark::State& state, bool with_coulomb)
      : jet(long_jet(static_cast<std::size_t>(state.range(0)))) {
    omp_set_num_threads(static_cast<int>(state.range(1)));
    Scene scene = read_scene(EHDJET_SCENES "/pvp.toml");
    scene.config.coulomb->solver = "fmm", scene.config.coulomb->tolerance = 1e-3;
    if (!with_coulomb) scene.config.coulomb.reset();
    dynamics = build_dynamics(scene);
    dynamics->bind(jet);
  }
  JetState jet;
  std::unique_ptr<JetDynamics> dynamics;
};

void evaluate_long(benchmark::State& state, bool with_coulomb) {
  LongJet of(state, with_coulomb);
  std::vector<double> rate(of.jet.y.size());
  for (auto _ : state) {
    of.dynamics->evaluate(of.jet.time, of.jet.y, rate);
    benchmark::DoNotOptimize(rate.data());
  }
}

/// What a step adds to its evaluations, divided by their number: those of a system that costs
/// nothing.
void combine_long(benchmark::State& state) {
  struct AtRest final : OdeSystem {
    void evaluate(double, std::span<const double>, std::span<double>) override { ++count; }
    std::size_t count = 0;
  } system;
  omp_set_num_threads(static_cast<int>(state.range(1)));
  const std::vector<double> y(7 * static_cast<std::size_t>(state.range(0)), 1.0);
  RungeKutta integrator(butcher_tableau("dormand-prince"),
                        {.rtol = 1e-6, .column_scale = {2e-4, 2e-4, 2e-4, 1, 1, 1, 500}});
  (void)integrator.attempt(system, 0, 1e-6, y); // allocates
  system.count = 0;
  for (auto _ : state) benchmark::DoNotOptimize(integrator.attempt(system, 0, 1e-6, y));
  state.counters["per_evaluation"] =
      benchmark::Counter(static_cast<double>(system.count),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void bind_long(benchmark::State& state) {
  LongJet of(state, false);
  for (auto _ : state) of.dynamics->bind(of.jet);
}

void linearize_long(benchmark::State& state) {
  LongJet of(state, false);
  for (auto _ : state) of.dynamics->stiff_part()->linearize(of.jet.time, of.jet.y);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgsProduct({{1'000, 10'000, 100'000, 1'000'000}, {1, 2}})
      ->UseRealTime()
      ->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(evaluate_long, everything, true)->Apply(sizes);
BENCHMARK_CAPTURE(evaluate_long, everything_else, false)->Apply(sizes);
BENCHMARK(combine_long)->Apply(sizes);
BENCHMARK(bind_long)->Apply(sizes);
BENCHMARK(linearize_long)->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
