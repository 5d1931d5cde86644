#include "ehdjet/core/error.hpp"
#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/allocations.hpp"
#include "support/quiet_steps.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

const std::vector<std::string> methods{"euler",  "heun",     "rk4", "dormand-prince",
                                       "dop853", "ros34pw2", "auto"};

/// A tolerance or step that suits the start of the PVP jet.
double suitable(const std::string& method) {
  return method == "euler" || method == "heun" ? 1e-6 : method == "rk4" ? 5e-6 : 1e-6;
}

void expect_same_bits(const JetState& a, const JetState& b, const std::string& label) {
  EXPECT_EQ(a.time, b.time) << label;
  EXPECT_EQ(a.y, b.y) << label; // no NaN is equal to itself
  EXPECT_EQ(a.mass, b.mass) << label;
  EXPECT_EQ(a.charge, b.charge) << label;
  EXPECT_EQ(a.volume, b.volume) << label;
  EXPECT_EQ(a.has_embryo, b.has_embryo) << label;
}

TEST(Simulation, gives_the_same_bits_every_time) {
  for (const std::string& method : methods) {
    const Scene scene = case_one(method, suitable(method));
    const auto first = run(scene, 1e-3), second = run(scene, 1e-3);
    EXPECT_GT(first->statistics().releases, 5U) << method;
    expect_same_bits(first->jet(), second->jet(), method);
  }
}

// Whatever the observers look at, between steps or at the time of an event.
TEST(Simulation, observers_do_not_change_a_bit_of_the_jet) {
  for (const std::string& method : methods) {
    for (const auto placement : {EventPlacement::located, EventPlacement::step_end}) {
      Scene scene = case_one(method, suitable(method));
      scene.config.integrator.events = placement;
      const auto unseen = run(scene, 1e-3);
      auto seen = build_simulation(scene);
      int looks = 0;
      const auto count = [&](const JetSnapshot&) { ++looks; };
      seen->add(std::make_unique<Watch>(1e-6 / 3, count));
      seen->add(std::make_unique<Watch>(1e-4, count));
      std::vector<DepositedBead> deposit;
      seen->add(std::make_unique<Deposit>(deposit));
      seen->run_until(1e-3);
      EXPECT_EQ(looks, 3001 + 11) << method;
      expect_same_bits(seen->jet(), unseen->jet(), method);
      EXPECT_EQ(seen->statistics().steps, unseen->statistics().steps) << method;
    }
  }
}

TEST(Simulation, observers_see_their_times_once_each_and_the_nozzle_in_its_place) {
  auto simulation = build_simulation(case_one("dormand-prince", 1e-6));
  std::vector<double> times;
  const double interval = 7e-6;
  simulation->add(std::make_unique<Watch>(interval, [&](const JetSnapshot& s) {
    times.push_back(s.time);
    const double angle = 1e4 * s.time;
    const Vec3 nozzle = 1e-5 * Vec3(0, std::cos(angle), std::sin(angle));
    EXPECT_LE((s.columns.position()[0] - nozzle).norm(), 1e-14 * 1e-5) << s.time;
    EXPECT_EQ(s.columns.beads, s.jet.beads());
    if (s.jet.has_embryo) {
      const double distance = (s.columns.position()[1] - s.columns.position()[0]).norm();
      EXPECT_NEAR(distance / pvp::link_length, 1, 1e-13) << s.time;
    }
  }));
  simulation->run_until(7e-4);
  ASSERT_EQ(times.size(), 101U);
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_EQ(times[i], static_cast<double>(i) * interval);
}

// What an observer sees between steps is as good as the steps.
TEST(Simulation, observers_see_the_jet_as_exactly_as_it_is_computed) {
  const GoldenChain golden("free");
  for (const std::string method : {"dormand-prince", "dop853"}) {
    Scene scene = golden.scene;
    integrate(scene, method, 1e-9);
    auto simulation = build_simulation(scene);
    double worst = 0;
    simulation->add(std::make_unique<Watch>(1e-5, [&](const JetSnapshot& s) {
      for (std::size_t i = 0; i < golden.times(); ++i) {
        if (std::abs(s.time - golden.time(i)) > 1e-12) continue;
        for (std::size_t k = 0; k < golden.size(); ++k)
          worst = std::max(worst, (s.columns.position()[k] - golden.position(i, k)).norm());
      }
    }));
    simulation->run_until(3e-4);
    EXPECT_LE(worst, 1e-7 * pvp::link_length) << method;
    EXPECT_GT(worst, 0) << method;
  }
}

// "auto" looks at the stiff part every eight steps only, and needs room for new beads then.
TEST(Simulation, a_step_allocates_nothing_while_the_chain_stays) {
  for (const std::string& method : methods) {
    if (method == "auto") continue;
    auto simulation = build_simulation(case_one(method, suitable(method)));
    expect_quiet_steps(*simulation, method);
  }
}

TEST(Simulation, a_chain_that_keeps_its_beads_allocates_nothing_at_all) {
  for (const std::string& method : methods) {
    GoldenChain golden("held");
    integrate(golden.scene, method,
              integration_method(method).estimates_errors ? 1e-8 : 1e-7);
    auto simulation = build_simulation(golden.scene);
    simulation->run_until(1e-5);
    const std::size_t before = allocations();
    simulation->run_until(5e-5);
    EXPECT_EQ(allocations() - before, 0) << method;
  }
}

TEST(Simulation, zero_charge_is_the_same_as_no_coulomb_term) {
  GoldenChain golden("held");
  Scene& scene = golden.scene;
  scene.chain.charge.assign(golden.size(), 0.0);
  scene.config.gravity = GravityConfig{pvp::gravity};
  for (const std::string& method : methods) {
    integrate(scene, method, suitable(method));
    scene.config.coulomb = CoulombConfig{};
    const auto with = run(scene, 2e-4);
    scene.config.coulomb.reset();
    const auto without = run(scene, 2e-4);
    expect_same_bits(with->jet(), without->jet(), method);
  }
}

TEST(Simulation, a_straight_jet_stays_straight) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.nozzle->amplitude = 0;
  const auto simulation = run(scene, 2e-3);
  const auto c = simulation->jet().columns();
  EXPECT_GT(simulation->jet().beads(), 20U);
  for (std::size_t k = 0; k < simulation->jet().beads(); ++k) {
    EXPECT_EQ(c.position()[k].tail<2>().norm(), 0) << k;
    EXPECT_EQ(c.velocity()[k].tail<2>().norm(), 0) << k;
  }
}

// Lengths scaled by s, times unchanged: l, a, A, g, h, v_s, Phi0/h by s, G and mu by s^2, alpha by
// s^3. The jet of 10 nm links is the same jet.
TEST(Simulation, is_similar_to_itself_at_any_scale) {
  const double s = 1e-6 / 0.02;
  const Scene scene = case_one("dormand-prince", 1e-8);
  Scene small = scene;
  SceneConfig& c = small.config;
  c.nozzle->radius *= s, c.nozzle->link_length *= s, c.nozzle->amplitude *= s;
  *c.nozzle->velocity *= s;
  c.collector->distance *= s;
  *c.field->potential *= s * s;
  c.gravity->acceleration *= s;
  *c.viscoelasticity->elastic_modulus *= s * s, *c.viscoelasticity->viscosity *= s * s;
  c.surface_tension->coefficient *= s * s * s;
  c.integrator.velocity_scale *= s;
  const auto large_run = run(scene, 1e-3), small_run = run(small, 1e-3);
  const JetState &a = large_run->jet(), &b = small_run->jet();
  ASSERT_EQ(a.beads(), b.beads());
  ASSERT_EQ(a.has_embryo, b.has_embryo);
  EXPECT_EQ(large_run->statistics().steps, small_run->statistics().steps);
  const auto p = a.columns(), q = b.columns();
  for (std::size_t k = 0; k < a.beads(); ++k) {
    EXPECT_LE((p.position()[k] - q.position()[k] / s).norm(), 1e-10 * 0.01) << k;
    EXPECT_LE((p.velocity()[k] - q.velocity()[k] / s).norm(), 1e-10 * 10) << k;
    EXPECT_NEAR(stress_of(p)[k], stress_of(q)[k] / (s * s), 1e-10 * pvp::modulus) << k;
  }
}

TEST(Simulation, without_field_and_feed_it_ends_at_its_end_time) {
  for (const std::string& method : methods) {
    Scene scene = case_one(method, suitable(method));
    scene.config.field = FieldConfig{.potential = 0, .strength = {}};
    scene.config.nozzle->velocity = 0;
    scene.config.gravity.reset();
    const auto charged = run(scene, 5e-4); // the nozzle's charge still pushes
    EXPECT_EQ(charged->jet().time, 5e-4) << method;
    for (const double y : charged->jet().y) EXPECT_TRUE(std::isfinite(y)) << method;

    scene.config.coulomb.reset();
    scene.config.nozzle->amplitude = 0;
    const auto still = run(scene, 5e-4);
    EXPECT_EQ(still->jet().time, 5e-4) << method;
    EXPECT_EQ(still->statistics().insertions, 0U) << method;
    EXPECT_EQ(still->jet().columns().position()[1], Vec3(pvp::link_length, 0, 0)) << method;
  }
}

TEST(Simulation, fixed_steps_do_not_lose_time) {
  // 0.1 is no binary fraction: added up naively the steps would miss by 1e-10.
  Scene scene = chain_scene();
  add_bead(scene, pvp_bead({0, 0, 0}));
  add_bead(scene, pvp_bead({1e-3, 0, 0}, {1, 0, 0}));
  constexpr int steps = 300'000;
  const double dt = 1e-7;
  integrate_with_fixed_steps(scene, "euler", dt);
  auto simulation = build_simulation(scene);
  double worst = 0;
  std::uint64_t n = 0;
  simulation->after_each_step([&](const Simulation& s) {
    worst = std::max(worst, std::abs(s.jet().time - static_cast<double>(++n) * dt));
  });
  simulation->run_until(steps * dt);
  EXPECT_EQ(simulation->statistics().steps, static_cast<std::uint64_t>(steps));
  // The last place of a time of up to 0.03 s.
  EXPECT_LE(worst, 4 * std::numeric_limits<double>::epsilon() * steps * dt);
  EXPECT_NEAR(simulation->statistics().shortest_step / dt, 1, 1e-6);
}

// ---- failure --------------------------------------------------------------------------------

std::string failure(Simulation& simulation, double end_time) {
  try {
    simulation.run_until(end_time);
  } catch (const RunError& e) {
    EXPECT_EQ(e.exit_code(), 1);
    return e.what();
  }
  ADD_FAILURE() << "ran to " << simulation.jet().time;
  return "";
}
void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos)
        << "no `" << part << "` in: " << message;
}

// Unlike charges at rest fall onto each other in pi sqrt(m r0^3/(16 k q^2)): no step is short
// enough there.
TEST(Failure, a_collapse_of_the_step_names_time_bead_and_term) {
  Scene scene = chain_scene();
  Bead negative = pvp_bead({2e-4, 1e-4, -2e-4});
  negative.charge *= -1;
  add_bead(scene, pvp_bead({5e-3, 5e-3, 5e-3}));
  add_bead(scene, pvp_bead({0, 0, 0}));
  add_bead(scene, negative);
  scene.chain.mass[0] *= 1e6, scene.chain.charge[0] *= 1e-6; // an onlooker
  scene.config.coulomb = CoulombConfig{};
  const double r0 = 3e-4;
  const double collision =
      std::numbers::pi
      * std::sqrt(pvp::mass * std::pow(r0, 3)
                  / (16 * constants::coulomb * pvp::charge * pvp::charge));
  for (const std::string method : {"dormand-prince", "dop853"}) {
    integrate(scene, method, 1e-6);
    scene.config.integrator.position_scale = 1e-12;
    scene.config.integrator.min_step = 1e-15;
    auto simulation = build_simulation(scene);
    const std::string message = failure(*simulation, 2 * collision);
    expect_parts(message, {"t = ", " s", "bead ", "Coulomb"});
    EXPECT_TRUE(message.find("bead 1") != std::string::npos
                || message.find("bead 2") != std::string::npos)
        << message;
    EXPECT_NEAR(simulation->jet().time / collision, 1, 1e-3) << method;
    for (const double y : simulation->jet().y) EXPECT_TRUE(std::isfinite(y)) << method;
  }
}

/// A force on one bead that is not a number from some time on.
class Fuse final : public ForceTerm {
public:
  Fuse(std::size_t bead, double time)
      : bead_(bead)
      , time_(time) {}
  void add_force(const Stage& stage, Vec3View force) override {
    if (stage.time >= time_) force.y[bead_] = std::nan("");
  }
  [[nodiscard]] std::string_view name() const override { return "fuse"; }

private:
  std::size_t bead_;
  double time_;
};

TEST(Failure, a_nan_is_never_accepted_and_named) {
  const GoldenChain golden("free");
  constexpr double blows_at = 3.35e-5;
  for (const std::string& method : methods) {
    Scene scene = golden.scene;
    integrate(scene, method, suitable(method));
    auto dynamics = build_dynamics(scene);
    dynamics->add(std::make_unique<Fuse>(7, blows_at));
    const bool adaptive = scene.config.integrator.rtol.has_value();
    ErrorScale scale{.rtol = 1e-6, .column_scale = {2e-4, 2e-4, 2e-4, 1, 1, 1, 500}};
    Simulation simulation(
        initial_jet(scene), std::move(dynamics), make_integrator(method, scale),
        {.fixed = adaptive ? std::nullopt : std::optional(suitable(method)),
         .initial = {}});
    const std::string message = failure(simulation, 1e-4);
    expect_parts(message, {"t = ", "bead 7", "fuse"});
    EXPECT_NEAR(simulation.jet().time, blows_at, 5e-6) << method; // the longest step
    for (const double y : simulation.jet().y) EXPECT_TRUE(std::isfinite(y)) << method;
  }
}

TEST(Failure, a_state_that_is_not_a_number_is_named_with_its_bead) {
  for (const std::string& method : methods) {
    GoldenChain golden("free");
    golden.scene.chain.vz[4] = std::nan("");
    integrate(golden.scene, method, suitable(method));
    auto simulation = build_simulation(golden.scene);
    const std::string message = failure(*simulation, 1e-4);
    expect_parts(message, {"bead 4"});
    EXPECT_EQ(simulation->jet().time, 0) << method;
  }
}

// Explicit Euler with a step ten times too long: stiff links ring ever louder.
TEST(Failure, fixed_steps_that_overflow_end_the_run) {
  for (const std::string method : {"euler", "heun", "rk4"}) {
    GoldenChain golden("free");
    *golden.scene.config.viscoelasticity->elastic_modulus *= 1e6;
    integrate(golden.scene, method, 1e-5);
    auto simulation = build_simulation(golden.scene);
    const std::string message = failure(*simulation, 0.1);
    expect_parts(message, {"t = ", "bead "});
    for (const double y : simulation->jet().y) EXPECT_TRUE(std::isfinite(y)) << method;
  }
}

TEST(Failure, beads_in_the_same_place_are_skipped_and_counted) {
  Scene scene = chain_scene();
  for (const double x : {0.0, 1e-3, 2e-3, 3e-3}) add_bead(scene, pvp_bead({x, 2 * x, -x}));
  scene.chain.x[3] = scene.chain.x[1], scene.chain.y[3] = scene.chain.y[1];
  scene.chain.z[3] = scene.chain.z[1];
  scene.config.coulomb = CoulombConfig{};
  const auto simulation = run(scene, 1e-5);
  EXPECT_GT(simulation->dynamics().evaluations(), 1U);
  EXPECT_EQ(simulation->dynamics().coincident_pairs(), 1U);
  for (const double y : simulation->jet().y) EXPECT_TRUE(std::isfinite(y));
}

} // namespace
} // namespace ehdjet
