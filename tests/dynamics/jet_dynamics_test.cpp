#include "ehdjet/dynamics/jet_dynamics.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/chain.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::vector<std::string> term_names(const Scene& scene) {
  std::vector<std::string> names;
  const auto dynamics = build_dynamics(scene);
  for (const auto& term : dynamics->terms()) names.emplace_back(term->name());
  return names;
}

TEST(Composition, a_scene_has_the_terms_it_names_and_no_others) {
  const Scene all = case_one();
  EXPECT_EQ(term_names(all),
            (std::vector<std::string>{"external field", "gravity", "Coulomb",
                                      "surface tension (paper)", "viscoelasticity"}));
  Scene s = all;
  s.config.surface_tension->form = SurfaceTensionForm::line;
  EXPECT_EQ(term_names(s)[3], "surface tension (line)");
  s.config.surface_tension.reset();
  EXPECT_EQ(term_names(s), (std::vector<std::string>{"external field", "gravity", "Coulomb",
                                                     "viscoelasticity"}));
  s.config.coulomb.reset();
  EXPECT_EQ(term_names(s),
            (std::vector<std::string>{"external field", "gravity", "viscoelasticity"}));
  s.config.gravity.reset();
  s.config.viscoelasticity.reset();
  EXPECT_EQ(term_names(s), (std::vector<std::string>{"external field"}));
  s.config.field.reset();
  EXPECT_TRUE(term_names(s).empty());
}

TEST(Composition, stress_is_a_column_only_of_a_fluid_that_can_hold_it) {
  Scene s = case_one();
  const auto columns = [&] { return initial_jet(s).y.size() / initial_jet(s).beads(); };
  const auto has_stress = [&] {
    return initial_jet(s).table->find_integrated("stress").has_value();
  };
  EXPECT_EQ(columns(), 7U);
  EXPECT_TRUE(has_stress());
  s.config.viscoelasticity = ViscoelasticityConfig{.elastic_modulus = 0, .viscosity = 2};
  EXPECT_EQ(columns(), 6U);
  EXPECT_FALSE(has_stress());
  s.config.viscoelasticity = ViscoelasticityConfig{.elastic_modulus = 5e3, .viscosity = 0};
  EXPECT_EQ(columns(), 6U);
  EXPECT_FALSE(has_stress());
  s.config.viscoelasticity.reset();
  EXPECT_EQ(columns(), 6U);
  EXPECT_FALSE(has_stress());
  EXPECT_NO_THROW(run(s, 1e-4));
}

TEST(Composition, a_jet_starts_as_nozzle_and_one_bead_one_link_away) {
  const JetState jet = initial_jet(case_one());
  ASSERT_EQ(jet.beads(), 2U);
  const Bead bead = bead_at(jet, 1);
  EXPECT_EQ(bead.position, Vec3(pvp::link_length, 0, 0));
  EXPECT_EQ(bead.velocity, Vec3(pvp::velocity, 0, 0));
  EXPECT_EQ(stress_of(bead), 0);
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_NEAR(jet.charge[k] / (6.911503837897547e-2 * statC), 1, 4 * epsilon) << k;
    EXPECT_NEAR(jet.mass[k] / (1.318296354319669e-6 * gram), 1, 4 * epsilon) << k;
    EXPECT_NEAR(jet.volume[k] / (1.570796326794897e-6 * cm3), 1, 4 * epsilon) << k;
  }
}

/// A chain scene as the terms see it.
Chain as_chain(const JetState& jet) {
  Chain chain(jet.beads());
  chain.mass = jet.mass, chain.charge = jet.charge, chain.volume = jet.volume;
  std::ranges::copy(jet.y, chain.flat.begin());
  return chain;
}

/// Rates of a state, by bead.
struct Rates {
  Rates(JetDynamics& dynamics, double t, JetState jet)
      : rate(jet.y.size())
      , columns{rate, jet.beads()} {
    dynamics.bind(jet);
    dynamics.prescribe(t, jet.y);
    dynamics.evaluate(t, jet.y, rate);
  }
  std::vector<double> rate;
  JetColumns<double> columns;
};

TEST(GoldenForces, at_the_start_are_those_of_an_independent_computation) {
  for (const std::string kind : {"free", "held"}) {
    const GoldenChain golden(kind);
    const auto dynamics = build_dynamics(golden.scene);
    Chain chain = as_chain(initial_jet(golden.scene));
    for (const auto& term : dynamics->terms()) {
      const std::string column = term->name() == "Coulomb"                   ? "coulomb"
                                 : term->name() == "surface tension (paper)" ? "tension"
                                                                             : "";
      if (column.empty()) continue;
      const std::vector<Vec3> f = chain.force(*term);
      // Coulomb: of the sum of the pairs' sizes, which is about the force on the end bead.
      double size = 0;
      for (std::size_t k = 0; k < golden.size(); ++k) size = std::max(size, f[k].norm());
      for (std::size_t k = 0; k < golden.size(); ++k)
        EXPECT_LE((f[k] - golden.force(column, k)).norm(), 1e-13 * size) << column << k;
    }
  }
}

// The paper's form does not conserve momentum; the printed sums are in dyn.
TEST(GoldenForces, of_surface_tension_sum_to_zero_only_in_the_line_form) {
  GoldenChain golden("free");
  Chain chain = as_chain(initial_jet(golden.scene));
  for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
    golden.scene.config.surface_tension->form = form;
    const auto dynamics = build_dynamics(golden.scene);
    const std::vector<Vec3> f = chain.force(*dynamics->terms().at(2));
    if (form == SurfaceTensionForm::line) {
      EXPECT_GT(f[3].norm(), 0);
      EXPECT_LE(sum(f).norm(), 12 * epsilon * sum_of_norms(f));
      continue;
    }
    EXPECT_LE((sum(f) / dyn - Vec3(0, -1.0620534906e-2, 1.0667642e-2)).norm(), 1e-9);
    double sizes = 0;
    for (const Vec3& each : f) sizes += each.lpNorm<1>();
    EXPECT_NEAR(sizes / dyn, 0.0977, 5e-5);
  }
}

TEST(JetDynamics, divides_the_summed_force_by_each_beads_own_mass) {
  GoldenChain golden("free");
  for (std::size_t k = 0; k < golden.size(); ++k)
    golden.scene.chain.mass[k] *= 1 + static_cast<double>(k);
  const auto dynamics = build_dynamics(golden.scene);
  const JetState jet = initial_jet(golden.scene);
  const Rates rates(*dynamics, 0, jet);
  Chain chain = as_chain(jet);
  std::vector<Vec3> total(jet.beads(), Vec3::Zero());
  for (const auto& term : dynamics->terms()) {
    const std::vector<Vec3> f = chain.force(*term);
    for (std::size_t k = 0; k < jet.beads(); ++k) total[k] += f[k];
  }
  for (std::size_t k = 0; k < jet.beads(); ++k)
    EXPECT_LE((jet.mass[k] * rates.columns.velocity()[k] - total[k]).norm(),
              8 * epsilon * 20 * dyn)
        << k;
}

TEST(JetDynamics, positions_change_with_the_velocities) {
  GoldenChain golden("free");
  for (std::size_t k = 0; k < golden.size(); ++k)
    golden.scene.chain.vy[k] = 1 + static_cast<double>(k);
  const auto dynamics = build_dynamics(golden.scene);
  const Rates rates(*dynamics, 0, initial_jet(golden.scene));
  for (std::size_t k = 0; k < golden.size(); ++k)
    EXPECT_EQ(rates.columns.position()[k], Vec3(0, 1 + static_cast<double>(k), 0)) << k;
}

void expect_no_rate(const Rates& rates, std::size_t bead) {
  EXPECT_EQ(rates.columns.position()[bead], Vec3::Zero()) << bead;
  EXPECT_EQ(rates.columns.velocity()[bead], Vec3::Zero()) << bead;
  EXPECT_EQ(stress_of(rates.columns)[bead], 0) << bead;
}
bool moves(const Rates& rates, std::size_t bead) {
  return rates.columns.velocity()[bead].norm() > 0;
}

TEST(JetDynamics, held_ends_do_not_move_but_act_on_the_others) {
  GoldenChain golden("free");
  JetState jet = initial_jet(golden.scene);
  const std::size_t n = jet.links();
  for (std::size_t k = 1; k <= n; ++k)
    stress_of(jet.columns())[k] = 1e3 * static_cast<double>(k);
  const auto free = build_dynamics(golden.scene);
  const Rates free_rates(*free, 0, jet);
  for (const auto ends : {FixedEnds::first, FixedEnds::last, FixedEnds::both}) {
    golden.scene.config.chain->fixed = ends;
    const auto dynamics = build_dynamics(golden.scene);
    const Rates rates(*dynamics, 0, jet);
    EXPECT_EQ(moves(rates, 0), ends == FixedEnds::last);
    EXPECT_EQ(moves(rates, n), ends == FixedEnds::first);
    if (ends != FixedEnds::last) expect_no_rate(rates, 0);
    for (std::size_t k = 1; k <= n; ++k) // the last bead does not move, its link relaxes
      EXPECT_EQ(stress_of(rates.columns)[k], stress_of(free_rates.columns)[k]) << k;
    for (std::size_t k = 1; k < n; ++k)
      EXPECT_EQ(rates.columns.velocity()[k], free_rates.columns.velocity()[k]) << k;
  }
}

/// The PVP jet with an embryo and three more beads, bead 2 at `distance` from the nozzle at t.
JetState with_embryo(double distance, double t) {
  const Scene scene = case_one();
  JetState jet = initial_jet(scene);
  insert_bead(jet, 2, pvp_bead({8e-4, 2e-5, 1e-5}, {7, 0, 0.5}));
  insert_bead(jet, 3, pvp_bead({12e-4, -2e-5, 3e-5}, {9, -1, 0}));
  insert_bead(jet, 1, pvp_bead({2e-4, 0, 0}, {pvp::velocity, 0, 0}));
  jet.has_embryo = true;
  const double angle = 1e4 * t;
  const Vec3 nozzle = 1e-5 * Vec3(0, std::cos(angle), std::sin(angle));
  jet.columns().position().set(2, nozzle + distance * Vec3(0.96, 0.16, -0.229782505861521));
  jet.columns().velocity().set(2, {4, 0.2, 0.3});
  for (const std::size_t k : {2U, 3U, 4U})
    stress_of(jet.columns())[k] = 1e3 * static_cast<double>(k);
  return jet;
}

TEST(JetDynamics, puts_nozzle_and_embryo_in_their_places_at_any_time) {
  const double t = 1.234e-3, angle = 12.34;
  JetState jet = with_embryo(3.7e-4, t);
  const auto dynamics = build_dynamics(case_one());
  dynamics->bind(jet);
  dynamics->prescribe(t, jet.y);
  const auto r = jet.columns().position();
  const double round_off = 16 * epsilon * angle;
  EXPECT_LE((r[0] - 1e-5 * Vec3(0, std::cos(angle), std::sin(angle))).norm(),
            round_off * 1e-5);
  EXPECT_LE((jet.columns().velocity()[0]
             - Vec3(pvp::velocity, -0.1 * std::sin(angle), 0.1 * std::cos(angle)))
                .norm(),
            round_off * 0.1);
  EXPECT_NEAR((r[1] - r[0]).norm(), pvp::link_length, 8 * epsilon * pvp::link_length);
  EXPECT_LE((r[1] - r[0]).cross(r[2] - r[0]).norm(), 16 * epsilon * 1e-7);
  EXPECT_GT((r[1] - r[0]).dot(r[2] - r[0]), 0);
}

TEST(JetDynamics, nozzle_embryo_and_landed_beads_have_no_rates) {
  JetState jet = with_embryo(3.7e-4, 0);
  jet.landed = {{.bead = 3, .time = 0, .radius = 0}};
  const auto dynamics = build_dynamics(case_one());
  const Rates rates(*dynamics, 0, jet);
  for (const std::size_t k : {0U, 1U, 3U}) expect_no_rate(rates, k);
  EXPECT_TRUE(moves(rates, 2) && moves(rates, 4));
}

// The velocity of the nozzle, with v_s along x although it does not move that way, is in the
// strain rate of the link that ends there, across an embryo.
TEST(JetDynamics, the_link_at_the_nozzle_sees_the_nozzles_velocity) {
  JetState jet = with_embryo(3.7e-4, 0);
  const auto dynamics = build_dynamics(case_one());
  const Rates rates(*dynamics, 0, jet);
  const Vec3 nozzle(0, 1e-5, 0), nozzle_velocity(pvp::velocity, 0, 0.1);
  const Vec3 d = jet.columns().position()[2] - nozzle;
  const double strain_rate =
      (jet.columns().velocity()[2] - nozzle_velocity).dot(d) / d.squaredNorm();
  const double expected =
      pvp::modulus * strain_rate - stress_of(jet.columns())[2] / pvp::relaxation_time;
  EXPECT_NEAR(stress_of(rates.columns)[2] / expected, 1, 50 * epsilon);
}

// Only Coulomb and the distance change between the two chains.
TEST(JetDynamics, an_embryo_acts_with_the_share_of_its_charge_that_the_distance_gives) {
  Scene scene = case_one();
  scene.config.viscoelasticity.reset(), scene.config.surface_tension.reset();
  const auto dynamics = build_dynamics(scene);
  for (const double distance : {3e-4, 3.5e-4, 3.8e-4, 4e-4}) {
    JetState jet = with_embryo(distance, 0);
    jet.y.resize(6 * jet.beads()), jet.table = BeadTable::basic();
    const Rates rates(*dynamics, 0, jet);
    const double ramp = (distance - 3e-4) / 1e-4;
    const double share = (1 - std::cos(std::numbers::pi * ramp)) / 2;
    dynamics->prescribe(0, jet.y);
    const auto r = jet.columns().position();
    Vec3 field = Vec3::Zero();
    for (const std::size_t j : {0U, 1U, 3U, 4U}) {
      const Vec3 d = r[2] - r[j];
      field += constants::coulomb * pvp::charge * (j == 1 ? share : 1.0)
               / std::pow(d.norm(), 3) * d;
    }
    field.x() += pvp::potential / pvp::distance;
    Vec3 expected = pvp::charge / pvp::mass * field;
    expected.x() += pvp::gravity;
    // The ramp's argument is a small difference: epsilon times 4e-4/5e-5.
    EXPECT_LE((rates.columns.velocity()[2] - expected).norm(),
              100 * epsilon * expected.norm())
        << distance;
  }
}

TEST(JetDynamics, a_landed_leading_bead_keeps_pulling_with_its_last_stress) {
  JetState jet = with_embryo(3.7e-4, 0);
  stress_of(jet.columns())[4] = 4e5;
  jet.landed = {{.bead = 4, .time = 0, .radius = 0}};
  Scene scene = case_one();
  scene.config.coulomb.reset(), scene.config.surface_tension.reset();
  scene.config.field.reset(), scene.config.gravity.reset();
  const auto dynamics = build_dynamics(scene);
  const Rates rates(*dynamics, 0, jet);
  const auto tension = [&](std::size_t k) -> Vec3 {
    const Vec3 d = jet.columns().position()[k] - jet.columns().position()[k - 1];
    return jet.volume[k] * stress_of(jet.columns())[k] / d.squaredNorm() * d;
  };
  const Vec3 expected = (tension(4) - tension(3)) / jet.mass[3];
  EXPECT_LE((rates.columns.velocity()[3] - expected).norm(),
            20 * epsilon * expected.norm());
  EXPECT_EQ(stress_of(rates.columns)[4], 0);
}

TEST(JetDynamics, counts_a_coincident_pair_once_however_often_it_is_evaluated) {
  Scene scene = chain_scene();
  add_bead(scene, pvp_bead({0, 0, 0})), add_bead(scene, pvp_bead({1e-3, 2e-3, 0}));
  add_bead(scene, pvp_bead({2e-3, 1e-3, 1e-3})), add_bead(scene, pvp_bead({1e-3, 2e-3, 0}));
  scene.config.coulomb = CoulombConfig{};
  const auto dynamics = build_dynamics(scene);
  for (std::uint64_t call = 1; call <= 3; ++call) {
    const Rates rates(*dynamics, 0, initial_jet(scene));
    for (const double r : rates.rate) EXPECT_TRUE(std::isfinite(r));
    EXPECT_EQ(dynamics->coincident_pairs(), 1U);
    EXPECT_EQ(dynamics->evaluations(), call);
  }
}

// A part of the rates is what the whole has there, with every source; the forces of parts of the
// sources add up. The right-hand side is asked for parts when beads move at different paces.
TEST(JetDynamics, can_be_asked_for_some_beads_and_some_sources) {
  for (const bool with_embryo : {false, true})
    for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
      Scene scene = case_one();
      scene.config.surface_tension->form = form;
      const auto simulation = build_simulation(scene);
      for (double t = 1e-3;
           simulation->jet().time < 1e-3 || simulation->jet().has_embryo != with_embryo;
           t += 5e-6)
        simulation->run_until(t);
      JetState jet = simulation->jet();
      const std::size_t n = jet.beads();
      for (std::size_t k = 0; k < n; ++k) // off the axis
        jet.columns().position().y[k] += 1e-5 * std::sin(static_cast<double>(k));
      const auto dynamics = build_dynamics(scene);
      dynamics->bind(jet);
      dynamics->prescribe(jet.time, jet.y);
      const Rates whole(*dynamics, jet.time, jet);
      double fastest = 0;
      for (std::size_t k = 0; k < n; ++k)
        fastest = std::max(fastest, whole.columns.velocity()[k].norm());
      for (const auto& [begin, end] : {std::pair<std::size_t, std::size_t>{0, 1},
                                       {0, 2},
                                       {0, 5},
                                       {1, 2},
                                       {2, 9},
                                       {5, n},
                                       {n - 1, n}}) {
        const BeadRange targets{begin, end};
        std::vector<double> part(jet.y.size()), near(part), far(part);
        dynamics->evaluate(jet.time, jet.y, part, targets, {});
        dynamics->evaluate(jet.time, jet.y, near, targets, {0, 6});
        dynamics->evaluate(jet.time, jet.y, far, targets, {6, n});
        std::vector<double> none(part);
        dynamics->evaluate(jet.time, jet.y, none, targets, {0, 0});
        const JetColumns<double> some{part, n}, a{near, n}, b{far, n}, local{none, n};
        for (std::size_t k = begin; k < end; ++k) {
          EXPECT_EQ(some.position()[k], whole.columns.position()[k]) << k;
          EXPECT_EQ(stress_of(some)[k], stress_of(whole.columns)[k]) << k;
          EXPECT_LE((some.velocity()[k] - whole.columns.velocity()[k]).norm(),
                    1e-12 * fastest)
              << k << ' ' << begin << ' ' << end;
          EXPECT_LE((a.velocity()[k] + b.velocity()[k] - local.velocity()[k]
                     - whole.columns.velocity()[k])
                        .norm(),
                    1e-12 * fastest)
              << k;
        }
      }
    }
}

/// A force that is not a number on one bead.
class Poison final : public ForceTerm {
public:
  explicit Poison(std::size_t bead)
      : bead_(bead) {}
  void add_force(const Stage&, Vec3View force) override { force.x[bead_] = std::nan(""); }
  [[nodiscard]] std::string_view name() const override { return "poison"; }

private:
  std::size_t bead_;
};

TEST(Diagnosis, names_the_bead_and_the_term_whose_force_is_not_a_number) {
  GoldenChain golden("free");
  const auto dynamics = build_dynamics(golden.scene);
  dynamics->add(std::make_unique<Poison>(7));
  const JetState jet = initial_jet(golden.scene);
  dynamics->bind(jet);
  const std::string why = dynamics->diagnosis(0, jet.y, 3);
  EXPECT_NE(why.find("bead 7"), std::string::npos) << why;
  EXPECT_NE(why.find("poison"), std::string::npos) << why;
}

TEST(Diagnosis, names_a_bead_whose_state_is_not_a_number) {
  GoldenChain golden("free");
  const auto dynamics = build_dynamics(golden.scene);
  JetState jet = initial_jet(golden.scene);
  jet.columns().velocity().y[5] = std::nan("");
  dynamics->bind(jet);
  const std::string why = dynamics->diagnosis(0, jet.y, 3);
  EXPECT_NE(why.find("bead 5"), std::string::npos) << why;
}

TEST(Diagnosis, names_the_strongest_force_if_all_are_numbers) {
  GoldenChain golden("free");
  const auto dynamics = build_dynamics(golden.scene);
  const JetState jet = initial_jet(golden.scene);
  dynamics->bind(jet);
  const std::string why = dynamics->diagnosis(0, jet.y, 0);
  EXPECT_NE(why.find("bead 0"), std::string::npos) << why;
  EXPECT_NE(why.find("Coulomb"), std::string::npos) << why;
}

} // namespace
} // namespace ehdjet
