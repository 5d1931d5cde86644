#include "ehdjet/studies/cost_probe.hpp"

#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/simulation/build.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace ehdjet {
namespace {

/// A run at the end of one of its steps.
struct Sample {
  double time = 0, beads = 0, tip = 0; // [s], -, [m]
  double evaluations = 0, sums = 0;    // so far
  double wall = 0;                     // [s]
};

struct Enough {};

double beads_of(const Simulation& s) {
  return static_cast<double>(s.jet().beads());
}
double beads_of(const ArraySimulation& s) {
  return static_cast<double>(s.beads());
}
double time_of(const Simulation& s) {
  return s.jet().time;
}
double time_of(const ArraySimulation& s) {
  return s.time();
}
double tip_of(const JetState& jet) {
  return jet.columns().position().x[jet.beads() - 1];
}
double tip_of(const Simulation& s) {
  return tip_of(s.jet());
}
double tip_of(const ArraySimulation& s) {
  return tip_of(s.jet(0));
}

template <class S>
Sample sample_of(const S& simulation) {
  const RunStatistics& cost = simulation.statistics();
  const auto evaluations = static_cast<double>(cost.evaluations);
  return {.time = time_of(simulation),
          .beads = beads_of(simulation),
          .tip = tip_of(simulation),
          .evaluations = evaluations,
          .sums = cost.two_rates && cost.two_rates->steps > 0 ? cost.two_rates->full_sums
                                                              : evaluations,
          .wall = cost.wall_time};
}

/// The steps of the second half of the start, and the last one.
template <class S>
std::vector<Sample> samples_of(S& simulation, double end_time, double seconds) {
  std::vector<Sample> samples{sample_of(simulation)};
  simulation.after_each_step([&](const S& s) {
    samples.push_back(sample_of(s));
    if (samples.back().wall > seconds) throw Enough{};
  });
  try {
    simulation.run_until(end_time);
  } catch (const Enough&) { // the estimate goes on from here
  }
  return samples;
}

/// p in f ~ t^p between two times.
double power(double f0, double f1, double t0, double t1, double most) {
  if (!(f0 > 0) || !(f1 > f0) || !(t0 > 0)) return 0;
  return std::min(std::log(f1 / f0) / std::log(t1 / t0), most);
}

/// Of one sum over that many beads, up to a factor [s].
double price(const Scene& scene, double beads) {
  const auto& coulomb = scene.config.coulomb;
  if (!coulomb) return beads;
  const CostModel& costs = scene.costs ? *scene.costs : CostModel::shipped();
  const auto n = static_cast<std::size_t>(std::max(beads, 2.0));
  const double tolerance = coulomb->tolerance;
  if (coulomb->solver == "auto")
    return costs.cost(costs.cheapest(n, tolerance), n, tolerance);
  // The treecode has no table. It grows with the beads as the fast multipole method does.
  return costs.cost(coulomb->solver == "direct" ? "direct" : "fmm", n, tolerance);
}

CostEstimate estimate(const Scene& scene, const std::vector<Sample>& samples, bool landed) {
  constexpr std::size_t enough_for_two_rates = 200;
  constexpr double bytes_per_bead =
      8 * 14; // place, velocity, stress, radius, contents, marks
  constexpr int parts = 200;
  const SceneConfig& c = scene.config;
  const Sample& last = samples.back();
  const double end = c.run.end_time;
  CostEstimate e{.complete = last.time >= end,
                 .start = last.time,
                 .spent = last.wall,
                 .landed = landed,
                 .beads = last.beads,
                 .evaluations = last.evaluations,
                 .wall_time = last.wall};
  for (const Sample& s : samples) e.beads = std::max(e.beads, s.beads);
  const auto half = std::ranges::lower_bound(samples, last.time / 2, {}, &Sample::time);
  const double frames_per_second = c.output.frames ? 1 / *c.output.frames : 0;
  double before = 0;
  for (const Sample& s : samples) {
    e.frames += bytes_per_bead * s.beads * frames_per_second * (s.time - before);
    before = s.time;
  }
  const double span = last.time - half->time;
  if (e.complete || !(span > 0)) return e;

  const double growth = c.nozzle || c.refinement
                            ? power(half->beads, last.beads, half->time, last.time, 3)
                            : 0;
  double arrival = end;
  if (landed)
    arrival = last.time;
  else if (const double p = power(half->tip, last.tip, half->time, last.time, 3);
           c.collector && p > 0)
    arrival = last.time * std::pow(c.collector->distance / last.tip, 1 / p);
  const double evaluations = (last.evaluations - half->evaluations) / span,
               sums = (last.sums - half->sums) / span;
  const double paid = last.wall - half->wall;
  double owed = 0; // for the same, by the model
  for (auto s = half; s + 1 != samples.end(); ++s)
    owed += ((s + 1)->sums - s->sums) * price(scene, s->beads);
  const double scale = owed > 0 ? paid / owed : 0;
  const double h = (end - last.time) / parts;
  for (int i = 0; i < parts; ++i) {
    const double t = std::min(last.time + (i + 0.5) * h, std::max(arrival, last.time));
    const double beads = last.beads * std::pow(t / last.time, growth);
    e.beads = std::max(e.beads, beads);
    e.wall_time += h * sums * scale * price(scene, beads);
    e.frames += h * bytes_per_bead * beads * frames_per_second;
  }
  e.evaluations += evaluations * (end - last.time);
  e.two_rates_later = can_have_two_rates(c) && last.sums == last.evaluations
                      && e.beads >= enough_for_two_rates;
  return e;
}

} // namespace

CostEstimate probe_cost(const Scene& scene, double seconds,
                        std::optional<std::size_t> threads) {
  const ThreadCount during(threads ? threads : scene.config.run.threads);
  const double end = scene.config.run.end_time;
  if (scene.config.array) {
    const auto simulation = build_array_simulation(scene);
    const auto samples = samples_of(*simulation, end, seconds);
    return estimate(scene, samples, simulation->statistics().landings > 0);
  }
  const auto simulation = build_simulation(scene);
  const auto samples = samples_of(*simulation, end, seconds);
  return estimate(scene, samples, simulation->statistics().landings > 0);
}

} // namespace ehdjet
