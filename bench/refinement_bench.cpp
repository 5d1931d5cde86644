// What one refinement of a coil costs that cuts every link in two. The time per bead should not
// depend on the number of beads. Run: build/release/bench/refinement_bench

#include "ehdjet/refinement/refine_jet.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <utility>

namespace {

using namespace ehdjet;

JetState coil(std::size_t beads) {
  auto table = std::make_shared<BeadTable>();
  table->declare({.name = "stress", .unit = "Pa", .description = "", .weight = "volume"});
  JetState jet = blank_jet(std::move(table), beads);
  jet.mass.assign(beads, 1e-10), jet.charge.assign(beads, 1e-12);
  jet.volume.assign(beads, 1e-13);
  const auto c = jet.columns();
  constexpr double link = 1e-3, radius = 0.02;
  for (std::size_t k = 0; k < beads; ++k) {
    const double s = link * static_cast<double>(k), angle = s / radius;
    c.position().set(k, {0.1 * s, radius * std::cos(angle), radius * std::sin(angle)});
    c.velocity().set(k, {20, -5 * std::sin(angle), 5 * std::cos(angle)});
    c.column(6)[k] = 1e3 + s;
  }
  return jet;
}

void refine(benchmark::State& state, LinkRemap remap) {
  const JetState before = coil(static_cast<std::size_t>(state.range(0)) / 2);
  const RefinementRule rule{
      .length = 0.5e-3, .remap = remap, .coarsen = {}, .collector = {}};
  std::size_t beads = 0;
  for (auto _ : state) {
    state.PauseTiming();
    JetState jet = before;
    state.ResumeTiming();
    benchmark::DoNotOptimize(refine_jet(jet, rule));
    beads = jet.beads();
  }
  state.counters["beads"] = static_cast<double>(beads);
  state.counters["per_bead"] = benchmark::Counter(
      static_cast<double>(beads) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(refine, conservative, LinkRemap::conservative)
    ->Arg(1000)
    ->Arg(10'000)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(refine, paper, LinkRemap::paper)
    ->Arg(1000)
    ->Arg(100'000)
    ->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
