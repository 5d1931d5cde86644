#include "ehdjet/core/error.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/refined.hpp"

// A run that goes on from a checkpoint has the bits of the run that was not interrupted.
namespace ehdjet {
namespace {

using namespace test;

class OnCheckpoint final : public Observer {
public:
  using Keep = std::function<void(const Checkpoint&)>;
  explicit OnCheckpoint(Keep keep)
      : keep_(std::move(keep)) {}
  void checkpoint(const Checkpoint& c) override { keep_(c); }

private:
  Keep keep_;
};

/// A run with its checkpoints and what it was then.
struct CheckedRun {
  struct Moment {
    JetState jet;
    Ledger ledger;
    RunStatistics statistics;
  };
  CheckedRun(const Scene& scene, double interval)
      : simulation(build_simulation(scene)) {
    simulation->make_checkpoints(interval);
    simulation->add(std::make_unique<OnCheckpoint>([this](const Checkpoint& c) {
      checkpoints.push_back(c);
      moments.push_back(moment_of(*simulation));
    }));
  }
  static Moment moment_of(const Simulation& s) {
    return {s.jet(), s.ledger(), s.statistics()};
  }
  std::unique_ptr<Simulation> simulation;
  std::vector<Checkpoint> checkpoints;
  std::vector<Moment> moments;
};

double time_of(const Checkpoint& c) {
  return c.at("jet.time").at(0);
}

/// All that a run knows of itself, but the wall time: what one more checkpoint would say.
Checkpoint without_wall_time(Checkpoint c) {
  std::erase_if(c, [](const auto& list) { return list.first.ends_with("wall_time"); });
  return c;
}

void expect_equal(const Checkpoint& a, const Checkpoint& b, const std::string& what) {
  const Checkpoint one = without_wall_time(a), other = without_wall_time(b);
  ASSERT_EQ(one.size(), other.size());
  for (const auto& [name, list] : one)
    EXPECT_EQ(list, other.at(name)) << what << ' ' << name;
}

void expect_same(const CompensatedSum& a, const CompensatedSum& b) {
  EXPECT_EQ(a.leading(), b.leading());
  EXPECT_EQ(a.carry(), b.carry());
}

void expect_same(const JetState& a, const JetState& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.charge, b.charge);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.has_embryo, b.has_embryo);
  EXPECT_EQ(a.absorbing_plane, b.absorbing_plane);
  ASSERT_EQ(a.landed.size(), b.landed.size());
  for (std::size_t i = 0; i < a.landed.size(); ++i) {
    EXPECT_EQ(a.landed[i].bead, b.landed[i].bead);
    EXPECT_EQ(a.landed[i].time, b.landed[i].time);
    EXPECT_EQ(a.landed[i].radius, b.landed[i].radius);
  }
}

void expect_same(const Ledger& a, const Ledger& b) {
  EXPECT_EQ(a.inserted_beads, b.inserted_beads);
  EXPECT_EQ(a.removed_beads, b.removed_beads);
  expect_same(a.inserted_mass, b.inserted_mass);
  expect_same(a.removed_mass, b.removed_mass);
  expect_same(a.inserted_charge, b.inserted_charge);
  expect_same(a.removed_charge, b.removed_charge);
  expect_same(a.inserted_volume, b.inserted_volume);
  expect_same(a.removed_volume, b.removed_volume);
  EXPECT_EQ(a.release_speed, b.release_speed);
  EXPECT_EQ(a.impact_speed, b.impact_speed);
  EXPECT_EQ(a.collector_radius, b.collector_radius);
}

void expect_same(const RunStatistics& a, const RunStatistics& b) {
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.insertions, b.insertions);
  EXPECT_EQ(a.releases, b.releases);
  EXPECT_EQ(a.landings, b.landings);
  EXPECT_EQ(a.refinements, b.refinements);
  EXPECT_EQ(a.method.has_value(), b.method.has_value());
  if (a.method && b.method) {
    EXPECT_EQ(a.method->in_use, b.method->in_use);
    EXPECT_EQ(a.method->since, b.method->since);
    EXPECT_EQ(a.method->changes, b.method->changes);
  }
  EXPECT_EQ(a.coulomb_error, b.coulomb_error);
  EXPECT_EQ(a.coulomb_violations, b.coulomb_violations);
  EXPECT_EQ(a.coincident_pairs, b.coincident_pairs);
  EXPECT_EQ(a.shortest_step, b.shortest_step);
  EXPECT_EQ(a.longest_step, b.longest_step);
}

void expect_same(const CheckedRun::Moment& a, const CheckedRun::Moment& b) {
  expect_same(a.jet, b.jet);
  expect_same(a.ledger, b.ledger);
  expect_same(a.statistics, b.statistics);
}
void expect_same_end(const Simulation& whole, const Simulation& continued) {
  expect_same(CheckedRun::moment_of(whole), CheckedRun::moment_of(continued));
}

/// Runs a scene with checkpoints, goes on from each of them and compares all later ones and the
/// end. Returns the whole run.
CheckedRun expect_same_bits(const Scene& scene, double end_time, double interval) {
  CheckedRun whole(scene, interval);
  whole.simulation->run_until(end_time);
  EXPECT_GE(whole.checkpoints.size(), 2U);
  for (std::size_t k = 0; k < whole.checkpoints.size(); ++k) {
    CheckedRun rest(scene, interval);
    rest.simulation->restore(whole.checkpoints[k]);
    expect_same(whole.moments[k], CheckedRun::moment_of(*rest.simulation));
    rest.simulation->run_until(end_time);
    EXPECT_EQ(rest.checkpoints.size(), whole.checkpoints.size() - k - 1);
    for (std::size_t i = 0; i < rest.checkpoints.size(); ++i)
      expect_equal(whole.checkpoints[k + 1 + i], rest.checkpoints[i],
                   "from " + std::to_string(k) + " at " + std::to_string(k + 1 + i));
    expect_same_end(*whole.simulation, *rest.simulation);
    if (::testing::Test::HasFailure()) break; // the others would say the same
  }
  return whole;
}

TEST(Checkpoint, goes_on_with_the_same_bits_whatever_the_method) {
  for (const std::string method : {"dormand-prince", "dop853", "ros34pw2", "auto"}) {
    SCOPED_TRACE(method);
    const auto whole = expect_same_bits(case_one(method, 1e-6), 1.5e-3, 2e-4);
    EXPECT_GE(whole.simulation->statistics().releases, 3U);
    EXPECT_GT(whole.simulation->statistics().rejected, 0U);
  }
}

TEST(Checkpoint, does_not_change_the_run) {
  for (const std::string method : {"dormand-prince", "dop853", "ros34pw2", "two-rate"}) {
    SCOPED_TRACE(method);
    Scene scene = refined_case(0.4 * cm);
    integrate(scene, method, 1e-5);
    const auto without = build_simulation(scene);
    without->run_until(6e-3);
    CheckedRun with(scene, 1e-4);
    with.simulation->run_until(6e-3);
    EXPECT_GT(with.checkpoints.size(), 15U);
    expect_same_end(*without, *with.simulation);
  }
}

TEST(Checkpoint, is_also_made_when_someone_wants_it) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  CheckedRun whole(scene, 1);
  int asked = 0;
  whole.simulation->make_checkpoints_when([&] { return ++asked % 20 == 0; });
  whole.simulation->run_until(6e-4);
  ASSERT_GE(whole.checkpoints.size(), 2U);
  EXPECT_EQ(whole.checkpoints.size(), static_cast<std::size_t>(asked / 20));
  for (const Checkpoint& c : whole.checkpoints) {
    const auto rest = build_simulation(scene);
    rest->restore(c);
    rest->run_until(6e-4);
    expect_same_end(*whole.simulation, *rest);
  }
}

TEST(Checkpoint, goes_on_with_the_same_bits_with_fixed_steps) {
  Scene scene = case_one();
  integrate_with_fixed_steps(scene, "rk4", 1e-6);
  expect_same_bits(scene, 1e-3, 2.5e-4);
  scene.config.integrator.events = EventPlacement::step_end;
  expect_same_bits(scene, 1e-3, 2.5e-4);
}

// The choice of the method, its patience and its looks: a fluid that is stiff, and one at the edge.
TEST(Checkpoint, keeps_what_the_automatic_method_has_learnt) {
  std::uint64_t changes = 0;
  for (const auto& [modulus, viscosity] : {std::pair{1e9, 2.0}, {1e6, 2.0}, {1e9, 1e-3}}) {
    SCOPED_TRACE(modulus);
    Scene scene = case_one("auto", 1e-5);
    scene.config.viscoelasticity = ViscoelasticityConfig{modulus, viscosity};
    const auto whole = expect_same_bits(scene, 1.5e-3, 1e-4);
    changes += whole.simulation->statistics().method->changes;
    EXPECT_GE(whole.checkpoints.size(), 10U);
  }
  EXPECT_GT(changes, 3U);
}

/// A jet so fine that beads land every few steps, in the end.
Scene landing_scene(const std::string& method) {
  Scene scene = refined_case(0.8 * cm, 1e-3, 1e-4);
  scene.config.integrator.method = method;
  return scene;
}

TEST(Checkpoint, keeps_the_pace_of_the_landings) {
  for (const std::string method : {"dormand-prince", "two-rate"}) {
    SCOPED_TRACE(method);
    const auto whole = expect_same_bits(landing_scene(method), 15e-3, 1.7e-3);
    EXPECT_GT(whole.simulation->statistics().landings, 100U);
    bool passing = false, landed = false;
    for (const Checkpoint& c : whole.checkpoints) {
      passing |= !c.at("jet.absorbing_plane").empty();
      landed |= !c.at("jet.landed_bead").empty();
    }
    EXPECT_TRUE(passing);
    EXPECT_TRUE(landed);
  }
}

TEST(Checkpoint, keeps_the_methods_of_both_parts_of_a_stiff_jet) {
  Scene scene = refined_case(0.4 * cm);
  integrate(scene, "two-rate", 1e-4);
  scene.config.viscoelasticity = ViscoelasticityConfig{1e8, pvp::viscosity};
  const auto whole = expect_same_bits(scene, 8e-3, 1.1e-3);
  EXPECT_GT(whole.simulation->statistics().two_rates->steps, 5U);
}

TEST(Checkpoint, keeps_the_times_of_the_refinements) {
  Scene scene = refined_case(0.2 * cm, 2e-4);
  EXPECT_GT(expect_same_bits(scene, 4e-3, 5e-4).simulation->statistics().refinements, 2U);
  scene.config.integrator.events = EventPlacement::step_end;
  EXPECT_GT(expect_same_bits(scene, 4e-3, 5e-4).simulation->statistics().refinements, 2U);
}

/// The fast multipole method is the cheaper one from so many charges on.
CostModel prices(double crossover) {
  const std::vector<double> same(6, crossover);
  return {.charges = {1, crossover, 1e4},
          .tolerances = {1e-8, 1e-2},
          .direct = {1, crossover, 1e4},
          .jet = same,
          .cloud = same};
}

/// A jagged chain that flies apart.
Scene charged_chain(std::size_t beads, const std::string& solver) {
  Scene scene = chain_scene();
  for (std::size_t k = 0; k < beads; ++k) {
    const auto s = static_cast<double>(k);
    add_bead(scene,
             pvp_bead({2e-4 * s, 1e-4 * std::sin(0.3 * s), 1e-4 * std::cos(0.3 * s)}));
  }
  scene.config.coulomb = CoulombConfig{.solver = solver, .tolerance = 1e-4, .leaf = 8};
  scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  integrate(scene, "dormand-prince", 1e-6);
  return scene;
}

TEST(Checkpoint, goes_on_with_the_same_bits_with_every_solver) {
  for (const std::string solver : {"treecode", "fmm", "auto"}) {
    SCOPED_TRACE(solver);
    Scene scene = charged_chain(300, solver);
    scene.config.coulomb->check_every = 7;
    const auto whole = expect_same_bits(scene, 2e-5, 4e-6);
    EXPECT_GT(whole.checkpoints.back().at("dynamics.Coulomb.solver.checks").at(0), 0);
  }
}

// So many beads that the solvers share them out among threads.
TEST(Checkpoint, goes_on_with_the_same_bits_for_the_same_threads) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(2);
  for (const std::string solver : {"direct", "treecode", "fmm"}) {
    SCOPED_TRACE(solver);
    expect_same_bits(charged_chain(1500, solver), 2e-5, 4e-6);
  }
  omp_set_num_threads(threads);
}

// As if there had been violations before the first checkpoint.
TEST(Checkpoint, keeps_how_strict_a_solver_has_become) {
  for (const std::string solver : {"treecode", "fmm", "auto"}) {
    SCOPED_TRACE(solver);
    Scene scene = charged_chain(300, solver);
    scene.costs = prices(100);
    CheckedRun lax(scene, 3e-6);
    lax.simulation->run_until(2e-5);
    Checkpoint first = lax.checkpoints.at(0);
    if (solver == "auto")
      first.at("dynamics.Coulomb.solver.tightened") = {9};
    else
      first.at("dynamics.Coulomb.solver.strictness") = {std::ldexp(1, -9)};
    CheckedRun strict(scene, 3e-6), rest(scene, 3e-6);
    strict.simulation->restore(first);
    strict.simulation->run_until(2e-5);
    EXPECT_NE(strict.simulation->jet().y, lax.simulation->jet().y);
    rest.simulation->restore(strict.checkpoints.at(0));
    rest.simulation->run_until(2e-5);
    expect_same_end(*strict.simulation, *rest.simulation);
  }
}

// The fast multipole method is cheaper by less than is worth a switch: the direct sum stays,
// because it was in use before.
TEST(Checkpoint, keeps_the_choice_of_the_automatic_solver) {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.coulomb = CoulombConfig{.solver = "auto", .tolerance = 1e-3, .leaf = 8};
  CheckedRun jet(scene, 2e-4);
  jet.simulation->run_until(1.5e-3);
  const auto beads =
      static_cast<double>(jet.checkpoints.back().at("jet.columns.mass").size());
  scene.costs = prices(0.95 * beads);
  const auto whole = expect_same_bits(scene, 1.5e-3, 2e-4);
  const Checkpoint& last = whole.checkpoints.back();
  EXPECT_EQ(last.at("dynamics.Coulomb.solver.charges").at(0), beads);
  EXPECT_EQ(last.at("dynamics.Coulomb.solver.chosen").at(0), 0);
  EXPECT_EQ(scene.costs->cheapest(static_cast<std::size_t>(beads), 1e-3), "fmm");
}

// What the run was to end at later has no say in it.
TEST(Checkpoint, is_none_of_a_step_that_was_cut_for_the_end) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  CheckedRun brief(scene, 1e-4), whole(scene, 1e-4);
  brief.simulation->run_until(5e-4);
  whole.simulation->run_until(1e-3);
  ASSERT_GE(brief.checkpoints.size(), 3U);
  EXPECT_LT(time_of(brief.checkpoints.back()), 5e-4);
  for (std::size_t i = 0; i < brief.checkpoints.size(); ++i)
    expect_equal(brief.checkpoints[i], whole.checkpoints[i], std::to_string(i));
}

TEST(Checkpoint, comes_at_the_first_step_after_each_multiple_and_cuts_none) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  CheckedRun run(scene, 1e-4);
  std::vector<double> ends{0};
  run.simulation->after_each_step(
      [&](const Simulation& s) { ends.push_back(s.jet().time); });
  run.simulation->run_until(1.05e-3);
  std::vector<double> expected;
  for (std::size_t k = 1; k <= 10; ++k)
    expected.push_back(*std::ranges::lower_bound(ends, static_cast<double>(k) * 1e-4));
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  std::vector<double> times;
  for (const Checkpoint& c : run.checkpoints) times.push_back(time_of(c));
  EXPECT_EQ(times, expected);
}

TEST(Checkpoint, shows_observers_what_they_have_not_seen) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  CheckedRun whole(scene, 3e-4);
  std::vector<std::vector<double>> all, rest;
  whole.simulation->add(std::make_unique<Watch>(2e-5, [&](const JetSnapshot& s) {
    all.emplace_back(s.columns.flat.begin(), s.columns.flat.end());
    all.back().push_back(s.time);
  }));
  whole.simulation->run_until(1e-3);
  CheckedRun continued(scene, 3e-4);
  continued.simulation->restore(whole.checkpoints.at(1));
  continued.simulation->add(std::make_unique<Watch>(2e-5, [&](const JetSnapshot& s) {
    rest.emplace_back(s.columns.flat.begin(), s.columns.flat.end());
    rest.back().push_back(s.time);
  }));
  continued.simulation->run_until(1e-3);
  const auto first = std::ranges::find_if(
      all, [&](const auto& row) { return row.back() >= time_of(whole.checkpoints[1]); });
  EXPECT_EQ(rest, std::vector(first, all.end()));
}

TEST(Checkpoint, of_another_scene_or_damaged_is_refused) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  CheckedRun run(scene, 1e-4);
  run.simulation->run_until(3e-4);
  const Checkpoint good = run.checkpoints.back();
  Scene without_stress = scene;
  without_stress.config.viscoelasticity.reset();
  Scene refined = scene;
  refined.config.refinement = RefinementConfig{.length = 1e-3, .interval = 1e-4};
  EXPECT_THROW(build_simulation(without_stress)->restore(good), InputError);
  EXPECT_THROW(build_simulation(refined)->restore(good), InputError);
  Checkpoint shorter = good, less = good;
  shorter.at("jet.columns.charge").pop_back();
  less.erase("step");
  EXPECT_THROW(build_simulation(scene)->restore(shorter), InputError);
  EXPECT_THROW(build_simulation(scene)->restore(less), InputError);
  EXPECT_NO_THROW(build_simulation(scene)->restore(good));
}

/// Whether a run that goes on from any of its checkpoints with `fresh` instead of what the
/// checkpoint says ends up with other bits.
bool matters(const Scene& scene, double end_time, double interval, const std::string& name,
             const std::vector<double>& fresh) {
  CheckedRun whole(scene, interval);
  whole.simulation->run_until(end_time);
  for (Checkpoint c : whole.checkpoints) {
    c.at(name) = fresh;
    const auto rest = build_simulation(scene);
    rest->make_checkpoints(interval);
    rest->restore(c);
    rest->run_until(end_time);
    if (rest->jet().y != whole.simulation->jet().y
        || rest->statistics().evaluations != whole.simulation->statistics().evaluations)
      return true;
  }
  return false;
}

TEST(Checkpoint, keeps_the_round_off_of_the_time) {
  Scene scene = case_one();
  integrate_with_fixed_steps(scene, "rk4", 1e-6);
  CheckedRun whole(scene, 1e-5);
  whole.simulation->run_until(1e-4);
  bool other = false;
  for (const Checkpoint& c : whole.checkpoints) other |= c.at("time").at(1) != 0;
  EXPECT_TRUE(other);
  const auto rest = build_simulation(scene);
  const Checkpoint& last = whole.checkpoints.back();
  rest->restore(last);
  Checkpoint again;
  rest->make_checkpoints(1e-9);
  rest->add(std::make_unique<OnCheckpoint>([&](const Checkpoint& c) {
    if (again.empty()) again = c;
  }));
  rest->run_until(1e-4);
  CompensatedSum time(last.at("time").at(0), last.at("time").at(1));
  time += 1e-6;
  EXPECT_EQ(again.at("time"), (std::vector<double>{time.leading(), time.carry()}));
}

// A checkpoint has nothing that does not matter: without any of its numbers the jet is another one.
TEST(Checkpoint, without_any_of_its_parts_gives_other_bits) {
  const double never = std::numeric_limits<double>::infinity();
  const Scene jet = case_one("dormand-prince", 1e-6);
  for (const auto& [name, fresh] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"step", {0}},
           {"expected_event", {never}},
           {"restart_step", {0, 0, 0}},
           {"after_event", {}},
           {"integrator.first_rate", {}},
           {"step_size_control.previous_error", {1e-4}}})
    EXPECT_TRUE(matters(jet, 1.5e-3, 1e-5, name, fresh)) << name;

  for (const auto& [name, fresh] : std::vector<std::pair<std::string, double>>{
           {"landing.steps_per_landing", 100}, {"landing.last_step", 0}})
    EXPECT_TRUE(matters(landing_scene("dormand-prince"), 15e-3, 1.7e-3, name, {fresh}))
        << name;

  Scene two_rates = refined_case(0.4 * cm);
  integrate(two_rates, "two-rate", 1e-5);
  EXPECT_TRUE(matters(two_rates, 8e-3, 1.1e-3, "two_rate.ready", {0}));

  Scene stiff = case_one("auto", 1e-5); // goes to and fro between the methods
  stiff.config.viscoelasticity = ViscoelasticityConfig{1e6, 2};
  for (const auto& [name, fresh] :
       std::vector<std::pair<std::string, double>>{{"is_implicit", 0},
                                                   {"chosen", 0},
                                                   {"rejected", 0},
                                                   {"accepted", 0},
                                                   {"steps_to_look", 8},
                                                   {"in_a_row", 0},
                                                   {"patience", 24},
                                                   {"steps", 0},
                                                   {"left_implicit", 0}})
    EXPECT_TRUE(matters(stiff, 1.6e-3, 2e-5, "integrator." + name, {fresh})) << name;
}

} // namespace
} // namespace ehdjet
