#include "ehdjet/budget/balance.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/forces/coulomb_force.hpp"
#include "ehdjet/forces/external_field.hpp"
#include "ehdjet/forces/gravity.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/surface_tension.hpp"
#include "ehdjet/integrators/butcher_tableau.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/budgeted.hpp"
#include "support/independent_balance.hpp"
#include "support/own_event.hpp"
#include "support/own_force.hpp"
#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

const std::vector<std::string> adaptive{"dop853", "dormand-prince"};

// ---- given chains ---------------------------------------------------------------------------

TEST(Budget, of_a_chain_closes_to_round_off) {
  for (const std::string kind : {"free", "held"})
    for (const std::string& method : adaptive)
      for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
        GoldenChain golden(kind);
        golden.scene.config.surface_tension->form = form;
        golden.scene.config.gravity = GravityConfig{pvp::gravity};
        integrate(golden.scene, method, 1e-12);
        const FinishedRun run(golden.scene, 2e-4, 2e-4 / 7);
        ASSERT_EQ(run.rows.size(), 8U);
        EXPECT_LE(run.worst(), 1e-12 * run.rows.front().at("coulomb_energy"))
            << kind << method;
        EXPECT_GT(run.last().at("dissipated_energy"), 0);
        EXPECT_LE(run.last().at("momentum_residual_relative"), 1e-14) << kind << method;
      }
}

TEST(Budget, has_the_published_parts) {
  struct Row {
    std::string kind;
    double kinetic, coulomb, field, elastic, dissipated, work;
  };
  const Row published[] = {
      {"free", 3.232986979964, 2.318300608448, -0.1742397315794, 0.3487755145694,
       0.1086085046340, -0.004041428718567},
      {"held", 2.976400047240, 2.547721046573, -0.2113627942731, 0.4106961113568,
       0.1068253076179, -0.008193586239860},
  };
  for (const Row& row : published) {
    GoldenChain golden(row.kind);
    integrate(golden.scene, "dop853", 1e-12);
    const FinishedRun run(golden.scene, 2e-4, 1e-4);
    const BudgetRow& b = run.last();
    const double digits = 2e-12; // of numbers printed with 13
    EXPECT_NEAR(b.at("kinetic_energy") / erg / row.kinetic, 1, digits) << row.kind;
    EXPECT_NEAR(b.at("coulomb_energy") / erg / row.coulomb, 1, digits) << row.kind;
    EXPECT_NEAR(b.at("field_energy") / erg / row.field, 1, digits) << row.kind;
    EXPECT_NEAR(b.at("elastic_energy") / erg / row.elastic, 1, digits) << row.kind;
    EXPECT_NEAR(b.at("dissipated_energy") / erg / row.dissipated, 1, 10 * digits)
        << row.kind;
    EXPECT_NEAR(b.at("surface_work") / erg / row.work, 1, 100 * digits) << row.kind;
    if (row.kind != "free") continue;
    const BudgetRow& start = run.rows.front();
    EXPECT_NEAR(start.at("coulomb_energy") / erg / 6.009651446934868, 1, 1e-14);
    EXPECT_NEAR(start.at("field_energy") / erg / -0.1711781421802560, 1, 1e-14);
    EXPECT_EQ(start.at("energy_residual"), 0);
  }
}

// Ends that are held pull, but do no work; the link between is one like any other.
TEST(Budget, of_a_chain_held_at_both_ends_closes) {
  GoldenChain golden("free");
  golden.scene.config.chain->fixed = FixedEnds::both;
  for (double& stress : stresses(golden.scene.chain)) stress = 1e3;
  integrate(golden.scene, "dop853", 1e-11);
  const FinishedRun run(golden.scene, 2e-4, 1e-4);
  EXPECT_LE(run.worst(), 1e-12 * run.rows.front().at("coulomb_energy"));
  EXPECT_EQ(run.last().at("held_work"), 0);
  EXPECT_NE(run.last().at("held_impulse_x"), 0);
  EXPECT_LE(run.last().at("momentum_residual_relative"), 1e-11);
}

TEST(Budget, has_columns_for_what_the_scene_has_and_no_others) {
  using Names = std::vector<std::string>;
  const auto names = [](const Scene& scene) {
    Names all;
    const auto simulation = build_simulation(scene);
    const Budget budget(simulation->dynamics(), simulation->events());
    for (const auto& c : budget.columns()) all.push_back(c.name);
    return all;
  };
  Scene bare = chain_scene();
  add_bead(bare, pvp_bead({0, 0, 0}));
  add_bead(bare, pvp_bead({1e-3, 0, 0}));
  EXPECT_EQ(names(bare), (Names{"kinetic_energy", "energy_residual",
                                "energy_residual_relative", "momentum_x", "momentum_y",
                                "momentum_z", "momentum_residual_x", "momentum_residual_y",
                                "momentum_residual_z", "momentum_residual_relative"}));
  const Names golden = names(GoldenChain("held").scene);
  const auto has = [](const Names& all, const std::string& name) {
    return std::ranges::find(all, name) != all.end();
  };
  for (const std::string name : {"coulomb_energy", "field_energy", "elastic_energy",
                                 "dissipated_energy", "surface_work", "held_work"})
    EXPECT_TRUE(has(golden, name)) << name;
  for (const std::string name : {"gravity_energy", "surface_energy", "nozzle_work",
                                 "insertion_energy", "landing_energy", "refinement_energy"})
    EXPECT_FALSE(has(golden, name)) << name;
  const Names jet = names(refined_case(0.4 * cm));
  for (const std::string name :
       {"nozzle_work", "insertion_energy", "landing_energy", "refinement_energy"})
    EXPECT_TRUE(has(jet, name)) << name;
  EXPECT_FALSE(has(jet, "held_work"));
}

/// A term whose force is a little stronger than it says.
class Stronger final : public ForceTerm {
public:
  Stronger(std::unique_ptr<ForceTerm> term, double factor)
      : term_(std::move(term))
      , factor_(factor) {}
  [[nodiscard]] std::string_view name() const override { return term_->name(); }
  void add_force(const Stage& stage, Vec3View force) override {
    const std::size_t n = stage.beads();
    std::vector<double> own(3 * n);
    const std::span<double> f(own);
    const Vec3View view{f.subspan(0, n), f.subspan(n, n), f.subspan(2 * n, n)};
    term_->add_force(stage, view);
    for (std::size_t k = 0; k < n; ++k) force.add(k, factor_ * view[k]);
  }
  [[nodiscard]] std::vector<BeadColumn> columns() const override {
    return term_->columns();
  }
  void bind(const BeadTable& table) override { term_->bind(table); }
  void set_column_rates(const Stage& stage, JetColumns<double> rates) override {
    term_->set_column_rates(stage, rates);
  }
  // Its account is that of the force as it should be.
  [[nodiscard]] TermAccount account() const override { return term_->account(); }
  [[nodiscard]] double energy(const Stage& stage) override { return term_->energy(stage); }
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override {
    return term_->feeding_power(stage, rate);
  }
  void add_power(const Stage& stage, Exchange& exchange) override {
    term_->add_power(stage, exchange);
  }

private:
  std::unique_ptr<ForceTerm> term_;
  double factor_;
};

std::unique_ptr<Simulation> simulation_of(const Scene& scene,
                                          std::unique_ptr<JetDynamics> dynamics) {
  const ErrorScale scale{.rtol = 1e-10, .column_scale = {2e-4, 2e-4, 2e-4, 1, 1, 1, 500}};
  return std::make_unique<Simulation>(
      initial_jet(scene), std::move(dynamics),
      std::make_unique<RungeKutta>(butcher_tableau("dop853"), scale), StepLimits{});
}

// Every kind of force that stores energy: one that is off by a thousandth (gravity, weak as it is,
// by a hundredth) leaves a residual.
TEST(Budget, does_not_close_if_a_force_is_not_what_its_energy_says) {
  const std::string kinds[] = {"field", "gravity", "Coulomb", "fluid", "line"};
  for (const std::string& kind : kinds)
    for (const bool wrong : {false, true}) {
      const GoldenChain golden("free");
      const double factor = !wrong ? 1 : kind == "gravity" ? 1.01 : 1.001;
      auto dynamics = std::make_unique<JetDynamics>();
      const auto add = [&](const std::string& name, std::unique_ptr<ForceTerm> term) {
        if (name == kind) term = std::make_unique<Stronger>(std::move(term), factor);
        dynamics->add(std::move(term));
      };
      add("field", std::make_unique<ExternalField>(*golden.scene.config.field->strength));
      add("gravity", std::make_unique<Gravity>(pvp::gravity));
      add("Coulomb",
          std::make_unique<CoulombForce>(make_coulomb_solver({.solver = "direct"})));
      add("line", std::make_unique<LineSurfaceTension>(pvp::surface_tension));
      add("fluid", std::make_unique<Maxwell>(pvp::modulus, pvp::viscosity));
      BudgetedRun run(simulation_of(golden.scene, std::move(dynamics)), 2e-4);
      run.simulation->run_until(2e-4);
      if (wrong) {
        EXPECT_GT(run.worst(), 1e-8 * 6 * erg) << kind;
      } else {
        EXPECT_LT(run.worst(), 1e-9 * 6 * erg) << kind;
      }
    }
}

/// The stress of each link pulls at the next one.
class MisplacedStress final : public ForceTerm {
public:
  void add_force(const Stage& stage, Vec3View force) override {
    const Links& links = stage.links();
    const auto stress = stress_of(stage.columns);
    for (std::size_t k = links.first; k < links.last; ++k) {
      const double wrong = stage.volume[k] * (stress[k + 1] - stress[k])
                           / (links.length[k] * links.length[k]);
      const Vec3 pull = wrong * Vec3(links.dx[k], links.dy[k], links.dz[k]);
      force.add(k, -pull), force.add(k - 1, pull);
    }
  }
  [[nodiscard]] std::string_view name() const override { return "misplaced"; }
  [[nodiscard]] TermAccount account() const override {
    return {};
  } // neither work nor energy
};

TEST(Budget, does_not_close_if_stress_pulls_at_the_wrong_link) {
  const GoldenChain golden("free");
  auto dynamics = build_dynamics(golden.scene);
  dynamics->add(std::make_unique<MisplacedStress>());
  BudgetedRun run(simulation_of(golden.scene, std::move(dynamics)), 2e-4);
  run.simulation->run_until(2e-4);
  EXPECT_GT(std::abs(run.last().at("energy_residual_relative")), 1e-4);
}

// ---- forces and events from outside -------------------------------------------------------------

TEST(Budget, has_columns_for_a_force_and_an_event_of_another_program_and_closes) {
  for (const bool own : {false, true}) {
    const Scene scene = case_one("dormand-prince", 1e-7);
    auto dynamics = build_dynamics(scene);
    if (own) dynamics->add(std::make_unique<LinearDrag>(2 * pvp::mass / 1e-3));
    const ErrorScale scale{.rtol = 1e-7,
                           .column_scale = {2e-4, 2e-4, 2e-4, 1, 1, 1, 0.1 * pvp::modulus}};
    auto simulation = std::make_unique<Simulation>(
        initial_jet(scene), std::move(dynamics),
        std::make_unique<RungeKutta>(butcher_tableau("dormand-prince"), scale),
        StepLimits{});
    if (own) simulation->add(std::make_unique<Discharge>(5.03e-4, 0.3));
    BudgetedRun run(std::move(simulation), 1e-3);
    run.simulation->run_until(1e-3);
    const BudgetRow& last = run.last();
    EXPECT_LE(std::abs(last.at("energy_residual_relative")), 1e-6) << own;
    EXPECT_LE(last.at("momentum_residual_relative"), 1e-6) << own;
    EXPECT_EQ(last.contains("linear_drag_work"), own);
    EXPECT_EQ(last.contains("discharge_energy"), own);
    if (!own) continue;
    EXPECT_LT(last.at("linear_drag_work"), 0);
    EXPECT_LT(last.at("linear_drag_impulse_x"), 0);
    EXPECT_LT(last.at("discharge_energy"), 0);
  }
}

// ---- against an independent computation -------------------------------------------------------

/// Compares, at several times of a run, energies, flows and what events bring in.
class Comparison final : public Observer {
public:
  Comparison(const Scene& scene, const Simulation& simulation)
      : independent_(scene)
      , balance_(simulation.dynamics(), simulation.events()) {}
  [[nodiscard]] Interest interest() const override { return {.steps_and_events = true}; }
  void before_event(const Event&, const JetState& jet) override { before_ = jet; }
  void after_event(const Event& event, const JetState& jet) override {
    const auto total = [this](const JetState& j) {
      double sum = 0;
      for (const auto& [name, energy] : independent_.energies(j)) sum += energy;
      return sum;
    };
    const Flow flow = balance_.jump(before_, jet);
    EXPECT_NEAR(flow.energy, total(jet) - total(before_), 1e-12 * size_) << event.name();
    ++jumps;
  }
  void compare(JetState jet) {
    balance_.prescribe(jet);
    const auto energies = independent_.energies(jet);
    const JetEnergies ours = balance_.energies(jet);
    ASSERT_EQ(ours.stored.size() + 1, energies.size());
    size_ = 0;
    for (const auto& [name, energy] : energies) size_ += std::abs(energy);
    EXPECT_NEAR(ours.kinetic, energies.at("kinetic_energy"), 1e-14 * size_);
    for (std::size_t i = 0; i < ours.stored.size(); ++i)
      EXPECT_NEAR(ours.stored[i], energies.at(balance_.stores()[i].energy), 1e-13 * size_);

    const auto flows = independent_.flows(jet);
    double power = 0, force = 0;
    for (const auto& [name, flow] : flows)
      power += std::abs(flow.energy), force += flow.momentum.norm();
    const auto found = balance_.flows(jet);
    for (std::size_t c = 0; c < found.size(); ++c) {
      const std::string& name = balance_.channels()[c].name;
      const auto expected = flows.find(name);
      const Flow flow = expected == flows.end() ? Flow{} : expected->second;
      EXPECT_NEAR(found[c].energy, flow.energy, 1e-12 * power) << name << jet.time;
      EXPECT_LE((found[c].momentum - flow.momentum).norm(), 1e-12 * force)
          << name << jet.time;
      if (flow.energy != 0 || flow.momentum.norm() != 0) seen.insert(name);
    }
  }
  std::size_t jumps = 0;
  std::set<std::string> seen; // channels through which something went

private:
  IndependentBalance independent_;
  Balance balance_;
  JetState before_;
  double size_ = 0; // of the energies [J]
};

/// Channels that were compared while they were open, and the number of events.
std::pair<std::set<std::string>, std::size_t> compared(const Scene& scene, double end,
                                                       double interval) {
  const auto simulation = build_simulation(scene);
  auto made = std::make_unique<Comparison>(scene, *simulation);
  Comparison& comparison = *made;
  simulation->add(std::make_unique<Watch>(interval, [&](const JetSnapshot& s) {
    JetState jet = s.jet;
    jet.time = s.time;
    jet.y.assign(s.columns.flat.begin(), s.columns.flat.end());
    comparison.compare(jet);
  }));
  simulation->add(std::move(made));
  simulation->run_until(end);
  return {comparison.seen, comparison.jumps};
}

TEST(Balance, of_chains_is_what_an_independent_computation_finds) {
  for (const std::string kind : {"free", "held"})
    for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
      GoldenChain golden(kind);
      golden.scene.config.surface_tension->form = form;
      golden.scene.config.gravity = GravityConfig{pvp::gravity};
      const auto [seen, jumps] = compared(golden.scene, 2e-4, 2e-5);
      EXPECT_EQ(seen.contains("held"), kind == "held");
      EXPECT_EQ(seen.contains("surface"), form == SurfaceTensionForm::paper);
      EXPECT_TRUE(seen.contains("dissipation") && seen.contains("gravity"));
    }
}

TEST(Balance, of_jets_is_what_an_independent_computation_finds) {
  for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
    Scene start = case_one("dormand-prince", 1e-6);
    start.config.nozzle->velocity = 1; // counts in the work of the nozzle
    start.config.nozzle->amplitude = 1e-4;
    start.config.surface_tension->form = form;
    const auto [seen, jumps] = compared(start, 1e-3, 7e-6);
    for (const std::string name :
         {"nozzle", "insertion", "field", "gravity", "dissipation"})
      EXPECT_TRUE(seen.contains(name)) << name;
    EXPECT_GT(jumps, 20U);

    Scene landing = refined_case(0.8 * cm, 1e-3, 1e-4);
    landing.config.surface_tension->form = form;
    landing.config.integrator.landings = LandingSteps::located;
    const auto [channels, events] = compared(landing, 13e-3, 1e-4);
    EXPECT_TRUE(channels.contains("landing"));
    EXPECT_GT(events, 200U);
  }
}

// ---- jets -----------------------------------------------------------------------------------

/// A nozzle that moves and feeds so fast that its work counts.
Scene fast_nozzle(double rtol) {
  Scene scene = case_one("dormand-prince", rtol);
  scene.config.nozzle->velocity = 1;
  scene.config.nozzle->amplitude = 1e-4;
  return scene;
}

TEST(Budget, of_the_pvp_jet_closes_with_the_tolerance) {
  for (const bool fast : {false, true}) {
    double before = 1e-5;
    for (const double rtol : {1e-5, 1e-7, 1e-9}) {
      const Scene scene = fast ? fast_nozzle(rtol) : case_one("dormand-prince", rtol);
      const FinishedRun run(scene, 3e-3, 1e-3);
      EXPECT_GT(run.simulation->statistics().insertions, 40U);
      const double relative = std::abs(run.last().at("energy_residual_relative"));
      EXPECT_LE(relative, before) << rtol << fast;
      EXPECT_LE(run.last().at("momentum_residual_relative"), rtol) << fast;
      before = relative / 20; // a hundred times less tolerance
      if (fast) {
        EXPECT_GT(std::abs(run.last().at("nozzle_work")), 1e-9);
      }
    }
    EXPECT_LE(before, 1e-10) << fast;
  }
}

TEST(Budget, counts_line_tension_of_a_jet_at_a_nozzle) {
  Scene scene = fast_nozzle(1e-8);
  scene.config.surface_tension->form = SurfaceTensionForm::line;
  const FinishedRun run(scene, 2e-3, 1e-3);
  EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 1e-8);
  EXPECT_GT(run.last().at("surface_energy"), 0);
}

// Steps that go on through landings, refinements, all events of a jet.
TEST(Budget, of_a_refined_jet_that_lands_closes_with_the_tolerance) {
  for (const auto landings : {LandingSteps::automatic, LandingSteps::located}) {
    double before = 1e-4;
    for (const double rtol : {1e-4, 1e-6}) {
      Scene scene = refined_case(0.8 * cm, 1e-3, rtol);
      scene.config.integrator.landings = landings;
      BudgetedRun run(scene, 5e-3);
      std::vector<RefinementRecord> records;
      std::vector<DepositedBead> deposit;
      run.simulation->add(std::make_unique<Collected>(records, deposit));
      run.simulation->run_until(15e-3);
      EXPECT_EQ(run.simulation->jet().absorbing_plane.has_value(),
                landings == LandingSteps::automatic);
      ASSERT_GT(deposit.size(), 100U);
      const BudgetRow& last = run.last();
      const double relative = std::abs(last.at("energy_residual_relative"));
      EXPECT_LE(relative, before) << rtol;
      EXPECT_LE(last.at("momentum_residual_relative"), 2 * before) << rtol;
      before = relative / 10;

      // What others record of the same events.
      Vec3 momentum = Vec3::Zero();
      double kinetic = 0, potential = 0;
      for (const RefinementRecord& r : records) momentum += r.change.momentum;
      for (const DepositedBead& b : deposit) {
        kinetic += b.bead.mass * b.bead.velocity.squaredNorm() / 2;
        potential -=
            b.bead.charge * pvp::potential + b.bead.mass * pvp::gravity * pvp::distance;
      }
      EXPECT_NEAR(last.at("refinement_momentum_x"), momentum.x(), 1e-10 * momentum.norm());
      EXPECT_NE(last.at("refinement_energy"), 0);
      const double lost = -(kinetic + potential); // and Coulomb energy, some per cent
      EXPECT_NEAR(last.at("landing_energy") / lost, 1, 0.15);
      EXPECT_LT(last.at("landing_energy"), 0);
    }
  }
}

TEST(Budget, of_fixed_steps_and_snapped_events_is_as_good_as_the_steps) {
  double before = 1e-4;
  for (const double dt : {2e-6, 1e-6}) {
    Scene scene = case_one();
    integrate_with_fixed_steps(scene, "rk4", dt);
    const FinishedRun located(scene, 1e-3, 1e-3);
    const double residual = std::abs(located.last().at("energy_residual_relative"));
    EXPECT_LE(residual, before) << dt;
    before = residual / 4;
    scene.config.integrator.events = EventPlacement::step_end;
    const FinishedRun snapped(scene, 1e-3, 1e-3);
    EXPECT_LE(std::abs(snapped.last().at("energy_residual_relative")), 1e-4) << dt;
  }
}

TEST(Budget, does_not_change_a_bit_of_the_jet) {
  std::vector<std::pair<Scene, double>> runs;
  for (const std::string method : {"rk4", "dormand-prince", "dop853"})
    runs.emplace_back(case_one(method, method == "rk4" ? 5e-6 : 1e-6), 1e-3);
  runs.emplace_back(refined_case(0.8 * cm, 1e-3, 1e-5), 13e-3);
  Scene fast = refined_case(0.8 * cm, 1e-3, 1e-4);
  fast.config.coulomb = CoulombConfig{.solver = "auto", .tolerance = 1e-4};
  runs.emplace_back(fast, 13e-3);
  for (const auto& [scene, end] : runs) {
    const auto plain = run(scene, end);
    const FinishedRun accounted(scene, end, end / 30);
    EXPECT_EQ(accounted.simulation->jet().y, plain->jet().y);
    EXPECT_EQ(accounted.simulation->jet().time, plain->jet().time);
    EXPECT_EQ(accounted.simulation->statistics().steps, plain->statistics().steps);
  }
}

// How often it is looked at does not matter beyond the error of the quadrature.
TEST(Budget, is_the_same_however_often_it_is_written) {
  const Scene scene = case_one("dormand-prince", 1e-6);
  const FinishedRun rarely(scene, 1e-3, 1e-3), often(scene, 1e-3, 1e-6);
  EXPECT_EQ(rarely.last().at("kinetic_energy"), often.last().at("kinetic_energy"));
  for (const std::string name : {"dissipated_energy", "insertion_energy", "nozzle_work"})
    EXPECT_NEAR(rarely.last().at(name) / often.last().at(name), 1, 1e-9) << name;
}

// Forces within a tolerance: |residual| <= tolerance * integral of |F| |v|.
TEST(Budget, with_a_fast_solver_is_off_by_no_more_than_its_forces) {
  Scene scene = chain_scene();
  constexpr std::size_t n = 400;
  for (std::size_t k = 0; k < n; ++k) {
    const double s = static_cast<double>(k);
    add_bead(scene, pvp_bead({2e-4 * s, 4e-5 * std::sin(0.2 * s), 4e-5 * std::cos(0.2 * s)},
                             {3 * std::cos(0.1 * s), 0, 0}));
  }
  scene.config.coulomb = CoulombConfig{};
  integrate(scene, "dop853", 1e-10);
  const double end = 1e-4;
  const FinishedRun exact(scene, end, end);
  EXPECT_LE(exact.worst(), 1e-11 * exact.rows.front().at("coulomb_energy"));
  for (const std::string solver : {"fmm", "treecode"})
    for (const double tolerance : {1e-3, 1e-5}) {
      scene.config.coulomb =
          CoulombConfig{.solver = solver, .tolerance = tolerance, .leaf = 8};
      integrate(scene, "dormand-prince", 1e-7);
      BudgetedRun run(scene, end);
      const auto direct = make_coulomb_solver({.solver = "direct"});
      std::vector<double> f(3 * n);
      double action = 0, steps = 100; // integral of |F| |v|
      run.simulation->add(std::make_unique<Watch>(end / steps, [&](const JetSnapshot& s) {
        std::ranges::fill(f, 0.0);
        const std::span<double> all(f);
        direct->add_force({s.columns.position(), s.jet.charge},
                          {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)});
        double force = 0, speed = 0;
        for (const double c : f) force += c * c;
        for (const double c : s.columns.flat.subspan(3 * n, 3 * n)) speed += c * c;
        action += std::sqrt(force * speed) * end / steps;
      }));
      run.simulation->run_until(end);
      EXPECT_LE(run.worst(), tolerance * action) << solver << tolerance;
      EXPECT_GT(run.worst(), 1e-10 * exact.rows.front().at("coulomb_energy")) << solver;
    }
}

} // namespace
} // namespace ehdjet
