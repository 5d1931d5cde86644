// Time of one call of a Coulomb solver, and its error. Compare ratios within one run: the first rows
// are a plain scalar loop, whose time depends on nothing but the processor.

#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace ehdjet;

/// Straight for 1.6 cm, then a helix whose radius grows to 4 cm in 20 turns, 16 cm downstream:
/// 254 cm of jet with evenly spaced beads. A uniform cube of charges would not be like a jet.
struct Jet {
  std::vector<double> x, y, z, q, fx, fy, fz;

  explicit Jet(std::size_t n)
      : x(n)
      , y(n)
      , z(n)
      , q(n)
      , fx(n)
      , fy(n)
      , fz(n) {
    constexpr std::size_t fine = 200000; // points of the arc length table
    const auto at = [](double place) { return point(place / double(fine)); };
    std::vector<double> arc(fine + 1);
    for (std::size_t k = 1; k <= fine; ++k)
      arc[k] = arc[k - 1] + (at(double(k)) - at(double(k - 1))).norm();
    std::size_t k = 1;
    for (std::size_t i = 0; i < n; ++i) {
      const double s = arc[fine] * static_cast<double>(i) / static_cast<double>(n - 1);
      while (k < fine && arc[k] < s) ++k;
      const Vec3 r = at(double(k - 1) + (s - arc[k - 1]) / (arc[k] - arc[k - 1]));
      x[i] = r.x(), y[i] = r.y(), z[i] = r.z();
      q[i] = 1e-10 * (1 + 0.1 * std::sin(14 * M_PI * s / arc[fine]));
    }
  }
  [[nodiscard]] ConstVec3View r() const { return {x, y, z}; }
  [[nodiscard]] Vec3View force() { return {fx, fy, fz}; }

private:
  static Vec3 point(double t) { // [m]
    const double whipping = std::max(0.0, (t - 0.1) / 0.9), angle = 40 * M_PI * whipping;
    return {0.16 * t, 0.04 * whipping * std::cos(angle), 0.04 * whipping * std::sin(angle)};
  }
};

/// One root and one division a pair, every pair twice.
class ScalarLoop final : public CoulombSolver {
public:
  void add_force(const PointCharges& c, Vec3View force) override {
    add_force_from(c, c, force);
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    for (std::size_t i = 0; i < targets.size(); ++i) {
      Vec3 g = Vec3::Zero();
      for (std::size_t j = 0; j < sources.size(); ++j) {
        const Vec3 d = targets.r[i] - sources.r[j];
        const double r2 = d.squaredNorm();
        if (r2 > 0) g += sources.q[j] / (r2 * std::sqrt(r2)) * d;
      }
      force.add(i, constants::coulomb * targets.q[i] * g);
    }
  }
  [[nodiscard]] std::size_t coincident_pairs() const override { return 0; }
  [[nodiscard]] CoulombAccuracy accuracy() const override { return {}; }
  [[nodiscard]] std::string_view name() const override { return "scalar"; }
};

/// Counters: `per_pair`, time per ordered pair; the two norms of `sampled_error`.
void time_force(benchmark::State& state, CoulombSolver& solver, int threads) {
  Jet jet(static_cast<std::size_t>(state.range(0)));
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  solver.add_force({jet.r(), jet.q}, jet.force());
  const CoulombErrorSample error = sampled_error({jet.r(), jet.q}, jet.force());
  for (auto _ : state) {
    solver.add_force({jet.r(), jet.q}, jet.force());
    benchmark::DoNotOptimize(jet.fx.data());
    benchmark::ClobberMemory();
  }
  omp_set_num_threads(before);
  const double n = static_cast<double>(jet.q.size());
  state.counters["per_pair"] =
      benchmark::Counter(n * (n - 1), benchmark::Counter::kIsIterationInvariantRate
                                          | benchmark::Counter::kInvert);
  state.counters["err_l2"] = error.relative_l2;
  state.counters["err_max"] = error.worst_per_target;
}

void add_rows(const std::string& name, std::unique_ptr<CoulombSolver> solver, int threads) {
  auto* rows = benchmark::RegisterBenchmark(
      name.c_str(), [shared = std::shared_ptr(std::move(solver)), threads](auto& state) {
        time_force(state, *shared, threads);
      });
  for (const int n : {150, 267, 509, 1123, 10000}) rows->Arg(n);
  rows->UseRealTime()->Unit(benchmark::kMicrosecond);
}

} // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  add_rows("scalar/threads:1", std::make_unique<ScalarLoop>(), 1);
  for (const SimdLevel level : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
    if (level > best_simd_level()) continue;
    for (const int threads : std::set{1, omp_get_max_threads()}) {
      const std::string row = "direct/" + std::string(name_of(level)) + "/threads:";
      add_rows(row + std::to_string(threads), make_direct_sum(level), threads);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
