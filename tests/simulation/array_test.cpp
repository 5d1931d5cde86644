#include "ehdjet/core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/allocations.hpp"
#include "support/pumped.hpp"
#include "support/quiet_steps.hpp"
#include "support/refined.hpp"

// Several jets that repel each other (model 9).
namespace ehdjet {
namespace {

using namespace test;

Scene array_of(Scene scene, std::size_t rows, std::size_t columns, double spacing,
               ArrayPhases phases = ArrayPhases::equal) {
  scene.config.array =
      ArrayConfig{.rows = rows, .columns = columns, .spacing = spacing, .phases = phases};
  return scene;
}

std::unique_ptr<ArraySimulation> run_array(const Scene& scene, double end_time) {
  auto simulation = build_array_simulation(scene);
  simulation->run_until(end_time);
  return simulation;
}

void expect_same_chain(const JetState& a, const JetState& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.charge, b.charge);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.has_embryo, b.has_embryo);
  EXPECT_EQ(a.absorbing_plane, b.absorbing_plane);
  EXPECT_EQ(a.landed.size(), b.landed.size());
}

// ---- two and three parallel threads --------------------------------------------------------------

constexpr double thread_radius = 5e-6, separation = 0.01; // [m]

/// A straight thread of PVP at rest along x through (y, z), so long that its ends do not matter.
JetState thread_at(double y, double z) {
  constexpr std::size_t beads = 1001;
  constexpr double link = 4e-3; // its points act like a line beyond that
  JetState jet = blank_jet(BeadTable::basic(), beads);
  const LinkContent content =
      LinkContent::of_cylinder(thread_radius, link, pvp::density, pvp::charge_density);
  for (std::size_t k = 0; k < beads; ++k) {
    jet.columns().position().set(k, {(static_cast<double>(k) - beads / 2) * link, y, z});
    jet.volume[k] = content.volume, jet.mass[k] = content.mass,
    jet.charge[k] = content.charge;
  }
  return jet;
}

std::unique_ptr<ArraySimulation> threads(const std::vector<JetAxis>& axes) {
  auto dynamics =
      std::make_unique<ArrayDynamics>(make_coulomb_solver({.solver = "direct"}));
  std::vector<ArraySimulation::Member> members;
  for (const JetAxis& axis : axes) {
    auto jet = std::make_unique<JetDynamics>();
    const auto coulomb = std::make_shared<SharedCoulomb>();
    jet->add(coulomb);
    dynamics->add(std::move(jet), coulomb, axis);
    members.push_back({.jet = thread_at(0, 0)});
  }
  const ErrorScale scale{.rtol = 1e-8,
                         .column_scale = {separation, separation, separation, 1, 1, 1}};
  return std::make_unique<ArraySimulation>(std::move(members), std::move(dynamics),
                                           make_integrator("dop853", scale), StepLimits{});
}

Vec3 middle_of(const ArraySimulation& s, std::size_t j) {
  const JetState jet = s.jet_in_array(j);
  return jet.columns().position()[jet.beads() / 2];
}

// d'' = B/d with B = 4 k_C rho_q^2 pi a^2/rho. A thread of 4 m has 5e-5 less field at 2 cm than an
// endless one.
TEST(Array, of_two_threads_doubles_its_distance_in_time) {
  const auto simulation = threads({{.y = -separation / 2}, {.y = separation / 2}});
  simulation->run_until(17.8171766364e-3);
  EXPECT_NEAR((middle_of(*simulation, 1) - middle_of(*simulation, 0)).norm(),
              2 * separation, 1e-4 * separation);
}

TEST(Array, of_three_threads_on_a_ring_doubles_its_radius_in_time) {
  std::vector<JetAxis> ring;
  for (const double angle :
       {0.3, 0.3 + 2 * std::numbers::pi / 3, 0.3 + 4 * std::numbers::pi / 3})
    ring.push_back({.y = separation * std::cos(angle), .z = separation * std::sin(angle)});
  const auto simulation = threads(ring);
  simulation->run_until(25.1972928424e-3);
  for (std::size_t j = 0; j < 3; ++j)
    EXPECT_NEAR(middle_of(*simulation, j).norm(), 2 * separation, 2e-4 * separation);
}

TEST(Array, has_forces_between_its_jets_that_sum_to_zero) {
  const auto simulation =
      threads({{.y = 0, .z = 0}, {.y = 0.01, .z = 0.003}, {.y = -0.004}});
  simulation->run_until(5e-3);
  Vec3 sum = Vec3::Zero();
  double size = 0;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t k = 0; k < simulation->jet(j).beads(); ++k) {
      const Vec3 p =
          simulation->jet(j).mass[k] * simulation->jet(j).columns().velocity()[k];
      sum += p, size += p.norm();
    }
  EXPECT_LE(sum.norm(), 1e-13 * size);
}

// ---- an array of one jet is that jet -------------------------------------------------------------

void expect_the_single_jet(const Scene& scene, double end_time) {
  const auto single = run(scene, end_time);
  const auto array = run_array(array_of(scene, 1, 1, 0.01), end_time);
  expect_same_chain(array->jet(0), single->jet());
  EXPECT_EQ(array->statistics().evaluations, single->statistics().evaluations);
  EXPECT_EQ(array->statistics().steps, single->statistics().steps);
  EXPECT_EQ(array->statistics().landings, single->statistics().landings);
  EXPECT_EQ(array->statistics().refinements, single->statistics().refinements);
  EXPECT_EQ(double(array->ledger(0).removed_charge),
            double(single->ledger().removed_charge));
}

TEST(Array, of_one_jet_has_its_bits) {
  for (const char* method : {"dormand-prince", "dop853", "ros34pw2"}) {
    SCOPED_TRACE(method);
    expect_the_single_jet(case_one(method, 1e-5), 2e-3);
  }
  Scene fixed = case_one();
  integrate_with_fixed_steps(fixed, "rk4", 1e-6);
  expect_the_single_jet(fixed, 1e-3);
  fixed.config.integrator.events = EventPlacement::step_end;
  expect_the_single_jet(fixed, 1e-3);
}

TEST(Array, of_one_jet_has_its_landings_and_refinements) {
  Scene scene = refined_case(0.8 * cm, 1e-3, 1e-4);
  expect_the_single_jet(scene, 14e-3);
  scene.config.collector->charge = CollectorCharge::grounded;
  scene.config.refinement->mesh = RefinedMesh::cut;
  expect_the_single_jet(scene, 12e-3);
}

// ---- several jets --------------------------------------------------------------------------------

TEST(Array, of_jets_far_apart_has_single_jets) {
  constexpr double end = 4e-3;
  const Scene scene = case_one("dormand-prince", 1e-8);
  const auto single = run(scene, end);
  const auto array = run_array(array_of(scene, 1, 2, 1), end);
  for (std::size_t j = 0; j < 2; ++j)
    EXPECT_LE(largest_distance(array->jet(j), single->jet()), 1e-6) << j;
  EXPECT_NEAR(array->jet_in_array(1).columns().position()[0].y()
                  - array->jet_in_array(0).columns().position()[0].y(),
              1, 1e-12);
}

TEST(Array, spreads_the_phases_of_its_nozzles_over_a_turn) {
  const Scene scene = case_one();
  const auto equal = build_array_simulation(array_of(scene, 2, 2, 0.01)),
             spread =
                 build_array_simulation(array_of(scene, 2, 2, 0.01, ArrayPhases::spread));
  const double amplitude = scene.config.nozzle->amplitude;
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(equal->jet(j).columns().position()[0].y(), amplitude, 1e-15);
    const double angle = std::numbers::pi / 2 * static_cast<double>(j);
    const Vec3 place = spread->jet(j).columns().position()[0];
    EXPECT_NEAR(place.y(), amplitude * std::cos(angle), 1e-15);
    EXPECT_NEAR(place.z(), amplitude * std::sin(angle), 1e-15);
  }
  const Vec3 last = equal->jet_in_array(3).columns().position()[0];
  EXPECT_NEAR(last.y(), 0.005 + amplitude, 1e-15);
  EXPECT_NEAR(last.z(), 0.005, 1e-15);
}

/// Sums of what left or is still there.
void expect_conservation(const ArraySimulation& s) {
  for (std::size_t j = 0; j < s.jets(); ++j) {
    const JetState& jet = s.jet(j);
    const Ledger& ledger = s.ledger(j);
    double charge = 0, mass = 0;
    for (std::size_t k = 1; k < jet.beads(); ++k)
      charge += jet.charge[k], mass += jet.mass[k];
    const double inserted = ledger.inserted_charge, removed = ledger.removed_charge;
    EXPECT_NEAR(charge / (inserted - removed), 1, 1e-12) << j;
    EXPECT_NEAR(mass / (ledger.inserted_mass - ledger.removed_mass), 1, 1e-12) << j;
  }
}

TEST(Array, keeps_the_charge_of_each_jet_through_landings_and_refinements) {
  const auto simulation = run_array(
      array_of(refined_case(1 * cm, 1e-3, 1e-4), 1, 3, 0.01, ArrayPhases::spread), 13e-3);
  expect_conservation(*simulation);
  EXPECT_GT(simulation->statistics().landings, 30U);
  EXPECT_GT(simulation->statistics().refinements.value_or(0), 10U);
  // Landings of any jet are frequent, so that those of every jet do not end steps.
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_TRUE(simulation->jet(j).absorbing_plane) << j;
    EXPECT_GT(simulation->ledger(j).removed_beads, 5U) << j;
  }
}

TEST(Array, feeds_all_jets_by_pumps) {
  const Scene scene = jet_k(4e-4, 4e-3);
  expect_the_single_jet(scene, 5e-3);
  const auto simulation = run_array(array_of(scene, 2, 1, 0.01), 5e-3);
  expect_conservation(*simulation);
  EXPECT_EQ(simulation->jet(0).beads(), simulation->jet(1).beads());
  const auto tip_z = [&](std::size_t j) {
    const JetState& jet = simulation->jet(j);
    return jet.columns().position()[jet.links()].z();
  };
  EXPECT_LT(tip_z(0), -1e-3);
  EXPECT_GT(tip_z(1), 1e-3);
}

// Both switches happen at one instant, and the plate takes the deposit of both jets along.
TEST(Array, has_one_field_and_one_plate) {
  Scene scene = case_one("dormand-prince", 1e-5);
  scene.config.collector->charge = CollectorCharge::grounded;
  scene.config.collector->velocity = std::array{0.0, 1.0, 0.0};
  scene.config.field->waveform = FieldWaveform::square;
  scene.config.field->frequency = 400;
  expect_the_single_jet(scene, 5e-3);
  const auto simulation = run_array(array_of(scene, 1, 2, 0.01), 2e-3);
  for (std::size_t j = 0; j < 2; ++j) EXPECT_TRUE(simulation->jet(j).field_is_off) << j;
}

TEST(Array, repels_its_jets_alike_with_any_method_and_solver) {
  Scene scene = array_of(case_one("dop853", 1e-9), 1, 2, 0.01);
  const auto exact = run_array(scene, 3e-3);
  for (const char* method : {"dormand-prince", "ros34pw2", "auto"}) {
    integrate(scene, method, 1e-7);
    EXPECT_LE(largest_distance(run_array(scene, 3e-3)->jet(1), exact->jet(1)), 1e-5)
        << method;
  }
  integrate(scene, "dormand-prince", 1e-7);
  for (const char* solver : {"treecode", "fmm", "auto"}) {
    scene.config.coulomb->solver = solver, scene.config.coulomb->tolerance = 1e-6;
    EXPECT_LE(largest_distance(run_array(scene, 3e-3)->jet(1), exact->jet(1)), 1e-5)
        << solver;
  }
}

// ---- observers and checkpoints -------------------------------------------------------------------

class Watched final : public ArrayObserver {
public:
  explicit Watched(double interval)
      : schedule_(interval) {}
  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }
  void observe(const ArraySnapshot& s) override {
    schedule_.advance();
    for (std::size_t j = 0; j < s.jets.size(); ++j) {
      EXPECT_EQ(s.jets[j].time, s.time);
      seen.insert(seen.end(), s.jets[j].y.begin(), s.jets[j].y.end());
    }
  }
  void deposit(std::size_t j, const DepositedBead& bead) override {
    seen.push_back(static_cast<double>(j)), seen.push_back(bead.bead.position.y());
  }
  void checkpoint(const Checkpoint& c) override { checkpoints.push_back(c); }

  std::vector<double> seen;
  std::vector<Checkpoint> checkpoints;

private:
  Schedule schedule_;
};

struct WatchedRun {
  explicit WatchedRun(const Scene& scene)
      : simulation(build_array_simulation(scene)) {
    simulation->make_checkpoints(3e-3);
    simulation->add(watched);
  }
  std::unique_ptr<ArraySimulation> simulation;
  std::shared_ptr<Watched> watched = std::make_shared<Watched>(1e-4);
};

void expect_same_bits_from_checkpoints(const Scene& scene, double end_time) {
  WatchedRun whole(scene);
  whole.simulation->run_until(end_time);
  ASSERT_GE(whole.watched->checkpoints.size(), 2U);
  for (const Checkpoint& c : whole.watched->checkpoints) {
    WatchedRun rest(scene);
    rest.simulation->restore(c);
    rest.simulation->run_until(end_time);
    for (std::size_t j = 0; j < whole.simulation->jets(); ++j)
      expect_same_chain(rest.simulation->jet(j), whole.simulation->jet(j));
    EXPECT_EQ(rest.simulation->statistics().evaluations,
              whole.simulation->statistics().evaluations);
    const auto& all = whole.watched->seen;
    const auto& later = rest.watched->seen;
    ASSERT_LE(later.size(), all.size());
    EXPECT_TRUE(std::equal(later.rbegin(), later.rend(), all.rbegin()));
  }
}

TEST(Array, goes_on_from_a_checkpoint_with_the_same_bits) {
  expect_same_bits_from_checkpoints(
      array_of(refined_case(1 * cm, 1e-3, 1e-4), 1, 2, 0.01, ArrayPhases::spread), 12e-3);
  Scene automatic = array_of(case_one("auto", 1e-4), 1, 2, 0.01);
  expect_same_bits_from_checkpoints(automatic, 10e-3);
}

TEST(Array, shows_its_jets_where_they_are) {
  const Scene scene = array_of(case_one("dormand-prince", 1e-5), 1, 2, 0.03);
  const auto simulation = build_array_simulation(scene);
  const auto plain = run_array(scene, 2e-3);
  const auto watched = std::make_shared<Watched>(2e-3);
  simulation->add(watched);
  simulation->run_until(2e-3);
  expect_same_chain(simulation->jet(0), plain->jet(0)); // observers change nothing
  std::vector<double> end;
  for (std::size_t j = 0; j < 2; ++j) {
    const JetState jet = simulation->jet_in_array(j);
    end.insert(end.end(), jet.y.begin(), jet.y.end());
    EXPECT_NEAR(jet.columns().position()[0].y(), j == 0 ? -0.015 : 0.015, 2e-5);
  }
  ASSERT_GE(watched->seen.size(), end.size());
  EXPECT_TRUE(std::equal(end.rbegin(), end.rend(), watched->seen.rbegin()));
}

TEST(Array, allocates_nothing_in_a_step_while_its_chains_stay) {
  for (const char* method : {"dormand-prince", "ros34pw2"}) {
    const auto simulation = build_array_simulation(
        array_of(case_one(method, 1e-6), 1, 2, 0.01, ArrayPhases::spread));
    expect_quiet_steps(*simulation, method);
  }
}

TEST(Array, names_the_jet_that_ends_a_run) {
  Scene scene = array_of(case_one("dormand-prince", 1e-12), 1, 2, 0.01);
  scene.config.integrator.min_step = 1e-6;
  try {
    run_array(scene, 1e-3);
    FAIL();
  } catch (const RunError& e) {
    const std::string text = e.what();
    for (const char* part : {"collapsed at t = ", "of jet ", "the strongest force"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(Array, is_no_single_jet) {
  EXPECT_THROW(build_simulation(array_of(case_one(), 1, 2, 0.01)), InputError);
}

} // namespace
} // namespace ehdjet
