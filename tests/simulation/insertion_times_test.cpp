#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// The PVP jet from a nozzle at rest, without surface tension.
Scene still_nozzle(bool gravity, const std::string& method, double rtol_or_step) {
  Scene s = case_one(method, rtol_or_step);
  s.config.nozzle->amplitude = 0;
  s.config.surface_tension.reset();
  if (!gravity) s.config.gravity.reset();
  return s;
}

struct Happening {
  double time, speed, stress; ///< of the event, of the leading bead
};

/// The first insertion and the first release.
std::vector<Happening> first_events(const Scene& scene) {
  std::vector<Happening> seen;
  std::uint64_t events = 0;
  auto simulation = build_simulation(scene);
  simulation->after_each_step([&](const Simulation& s) {
    const std::uint64_t now = s.statistics().insertions + s.statistics().releases;
    if (now == events) return;
    events = now;
    const JetState& jet = s.jet();
    const std::size_t n = jet.links();
    EXPECT_EQ(jet.columns().velocity()[n].y(), 0);
    seen.push_back(
        {jet.time, jet.columns().velocity()[n].x(), stress_of(jet.columns())[n]});
  });
  simulation->run_until(8e-5);
  EXPECT_EQ(simulation->statistics().insertions, 1U);
  EXPECT_EQ(simulation->statistics().releases, 1U);
  seen.resize(2);
  return seen;
}

TEST(Insertion, first_happens_at_the_times_of_an_independent_computation) {
  for (const std::string method : {"dop853", "dormand-prince"}) {
    const auto without = first_events(still_nozzle(false, method, 1e-12));
    const double digits = 2e-11; // times are printed with 11, the rest with 9
    EXPECT_NEAR(without[0].time / 5.1019218390e-5, 1, digits) << method;
    EXPECT_NEAR(without[0].speed / (336.624179 * cm), 1, 2e-9) << method;
    EXPECT_NEAR(without[0].stress / (19284.8043 * dyn_cm2), 1, 3e-9) << method;
    EXPECT_NEAR(without[1].time / 7.4996532673e-5, 1, digits) << method;
    EXPECT_NEAR(without[1].speed / (538.033922 * cm), 1, 2e-9) << method;
    EXPECT_NEAR(without[1].stress / (32129.6577 * dyn_cm2), 1, 3e-9) << method;

    const auto with = first_events(still_nozzle(true, method, 1e-12));
    EXPECT_NEAR(with[0].time / 5.1015906424e-5, 1, digits) << method;
    EXPECT_NEAR(with[1].time / 7.4991241052e-5, 1, digits) << method;
  }
}

// The nozzle's charge is what pushes the first bead away. Without it the field alone needs 62 times
// as long for the first half link, held back by the stress: 3.1580 ms, integrated separately.
TEST(Insertion, would_wait_sixty_times_as_long_at_an_uncharged_nozzle) {
  Scene scene = still_nozzle(false, "dop853", 1e-12);
  scene.config.coulomb.reset();
  auto simulation = build_simulation(scene);
  double first = 0;
  simulation->after_each_step([&](const Simulation& s) {
    if (first == 0 && s.statistics().insertions > 0) first = s.jet().time;
  });
  simulation->run_until(5e-3);
  EXPECT_NEAR(first, 3.1580e-3, 2e-7);
}

TEST(Insertion, times_converge_at_the_order_of_the_method) {
  const auto exact = first_events(still_nozzle(false, "dop853", 1e-13));
  struct Row {
    std::string method;
    double step, order;
  };
  for (const auto& [method, step, order] :
       {Row{"euler", 1e-7, 1}, Row{"heun", 1e-6, 2}, Row{"rk4", 4e-6, 4}}) {
    std::vector<double> steps, insertion, release;
    for (int i = 0; i < 9; ++i) {
      steps.push_back(step * std::pow(2, -i / 2.0));
      const auto events = first_events(still_nozzle(false, method, steps.back()));
      insertion.push_back(std::abs(events[0].time - exact[0].time));
      release.push_back(std::abs(events[1].time - exact[1].time));
    }
    EXPECT_NEAR(observed_order(steps, insertion), order, 0.15) << method;
    EXPECT_NEAR(observed_order(steps, release), order, 0.15) << method;
  }
}

TEST(Insertion, at_step_ends_comes_up_to_a_step_late) {
  const auto exact = first_events(still_nozzle(false, "dop853", 1e-13));
  for (const double step : {1e-6, 3e-7, 1e-7}) {
    Scene scene = still_nozzle(false, "rk4", step);
    scene.config.integrator.events = EventPlacement::step_end;
    const auto events = first_events(scene);
    EXPECT_NEAR(std::remainder(events[0].time, step), 0, 1e-9 * step);
    EXPECT_GE(events[0].time, exact[0].time - 1e-9 * step);
    EXPECT_LE(events[0].time, exact[0].time + step);
  }
}

// Beads in free fall move on parabolas, which the dense output of every method knows exactly: so
// the events of many cycles are known in closed form, however long the steps.
TEST(Insertion, all_happen_when_a_step_holds_many) {
  constexpr double l = pvp::link_length, vs = pvp::velocity, field = 1e6;
  constexpr double a = pvp::charge_density / pvp::density * field;
  constexpr double end = 2e-3;
  std::uint64_t insertions = 0, releases = 0;
  double t = 0, v = vs; // of the bead that starts one link from the nozzle
  for (;;) {
    const auto speed_after = [&](double way) { return std::sqrt(v * v + 2 * a * way); };
    const double inserted = t + (speed_after(l / 2) - v) / a;
    const double released = t + (speed_after(l) - v) / a;
    insertions += inserted < end;
    releases += released < end;
    if (inserted >= end) break;
    t = released, v = (speed_after(l) + vs) / 2;
  }
  ASSERT_GT(insertions, 10U);

  for (const std::string method : {"heun", "rk4", "dormand-prince", "dop853"}) {
    for (const double step : {1e-3, 3e-4, 1e-5}) {
      Scene scene = case_one();
      scene.config.nozzle->amplitude = 0;
      scene.config.field = FieldConfig{.potential = {}, .strength = field};
      scene.config.coulomb.reset(), scene.config.gravity.reset();
      scene.config.viscoelasticity.reset(), scene.config.surface_tension.reset();
      integrate_with_fixed_steps(scene, method, step);
      const auto simulation = run(scene, end);
      EXPECT_EQ(simulation->statistics().insertions, insertions) << method << " " << step;
      EXPECT_EQ(simulation->statistics().releases, releases) << method << " " << step;
      // The bead of the start has fallen all the time.
      const JetState& jet = simulation->jet();
      const double fallen = l + vs * end + a * end * end / 2;
      EXPECT_NEAR(jet.columns().position()[jet.links()].x() / fallen, 1, 1e-12) << method;
    }
  }
}

} // namespace
} // namespace ehdjet
