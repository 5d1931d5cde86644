#include "ehdjet/core/error.hpp"
#include "ehdjet/events/pump.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/bookkeeping.hpp"
#include "support/budgeted.hpp"
#include "support/pumped.hpp"

namespace ehdjet {
namespace {

using namespace test;

struct Profile {
  std::vector<double> velocity, stress;
};

/// Means over 25 to 30 ms at these places, between the beads by straight lines.
Profile mean_profile(const Scene& scene, const std::vector<double>& places) {
  auto simulation = build_simulation(scene);
  Profile mean{std::vector<double>(places.size()), std::vector<double>(places.size())};
  double looks = 0;
  simulation->add(std::make_unique<Watch>(3.7e-6, [&](const JetSnapshot& s) {
    if (s.time < 25e-3) return;
    looks += 1;
    const auto x = s.columns.position().x, v = s.columns.velocity().x;
    const auto stress = stress_of(s.columns);
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::size_t k = 2;
      while (x[k] < places[i]) ++k;
      const double share = (places[i] - x[k - 1]) / (x[k] - x[k - 1]);
      mean.velocity[i] += v[k - 1] + share * (v[k] - v[k - 1]);
      mean.stress[i] += stress[k]; // in the link
    }
  }));
  simulation->run_until(30e-3);
  for (auto* column : {&mean.velocity, &mean.stress})
    for (double& value : *column) value /= looks;
  return mean;
}

// Against the continuum: dv/dx of a slender jet through its saddle, or with the stress of the nozzle.
TEST(PumpedJet, approaches_the_slender_jet_with_first_order_in_its_links) {
  struct Case {
    double flow_rate, viscosity, velocity, stress; // at 0.5 cm
    std::vector<double> errors;                    // published, l_step = 0.02 and 0.01 cm
  };
  for (const Case& c : {Case{20 * mL_h, 20 * poise, 266.661, 6460.6, {-5.2e-3, -2.1e-3}},
                        Case{74 * mL_h, 20 * poise, 414.312, 4800.3, {-1.3e-2, -7.3e-3}},
                        Case{20 * mL_h, 100 * poise, 248.943, 25938.5, {}},
                        Case{74 * mL_h, 100 * poise, 439.049, 17105.1, {}}}) {
    const std::vector<double> lengths{0.02 * cm, 0.01 * cm};
    std::vector<double> errors;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto mean =
          mean_profile(straight_pumped(c.flow_rate, c.viscosity, lengths[i]), {0.5 * cm});
      errors.push_back(mean.velocity[0] / (c.velocity * cm) - 1);
      if (!c.errors.empty()) {
        EXPECT_NEAR(errors[i] / c.errors[i], 1, 0.2) << c.flow_rate << " " << lengths[i];
      }
      EXPECT_NEAR(mean.stress[0] / (c.stress * dyn_cm2), 1, 0.05) << c.flow_rate;
    }
    EXPECT_LE(std::abs(errors[1]), 0.62 * std::abs(errors[0])) << c.flow_rate;
    EXPECT_LE(std::abs(errors[1]), 1e-2);
  }
}

TEST(PumpedJet, goes_on_as_the_slender_jet_far_from_the_nozzle) {
  const auto mean = mean_profile(straight_pumped(20 * mL_h, 20 * poise, 0.01 * cm),
                                 {2 * cm, 8 * cm, 12 * cm});
  EXPECT_NEAR(mean.velocity[0] / (585.948 * cm), 1, 1e-3);
  EXPECT_NEAR(mean.velocity[1] / (1230.396 * cm), 1, 3e-4);
  EXPECT_NEAR(mean.velocity[2] / (1517.410 * cm), 1, 2e-4);
}

TEST(PumpedJet, holds_what_has_been_pumped_at_any_time) {
  Scene scene = jet_k(0.02 * cm, 0.4 * cm);
  const double q = *scene.config.nozzle->flow_rate,
               start = scene.config.nozzle->section() * 0.02 * cm / 2;
  auto simulation = build_simulation(scene);
  double density = pvp::density, charge_density = *scene.config.nozzle->charge_density;
  simulation->after_each_step([&](const Simulation& s) {
    const JetState& jet = s.jet();
    const double volume = start + q * jet.time;
    const auto holds = [&](const std::vector<double>& chain, double removed,
                           double inserted, double per_volume) {
      const double whole = per_volume * volume;
      EXPECT_NEAR((sum_from_one(chain) + removed) / whole, 1, 1e-13) << jet.time;
      EXPECT_NEAR(inserted / whole, 1, 1e-13) << jet.time;
    };
    const Ledger& ledger = s.ledger();
    holds(jet.volume, ledger.removed_volume, ledger.inserted_volume, 1);
    holds(jet.mass, ledger.removed_mass, ledger.inserted_mass, density);
    holds(jet.charge, ledger.removed_charge, ledger.inserted_charge, charge_density);
  });
  // Between steps, too.
  simulation->add(std::make_unique<Watch>(3.3e-4, [&](const JetSnapshot& s) {
    EXPECT_NEAR(s.ledger.inserted_volume / (start + q * s.time), 1, 1e-13) << s.time;
    EXPECT_EQ(s.jet.charge[1], charge_density * s.jet.volume[1]);
  }));
  simulation->run_until(20e-3);
  EXPECT_GT(simulation->ledger().removed_beads, 20U);
  EXPECT_NEAR(static_cast<double>(simulation->statistics().insertions),
              q * 20e-3 / (2 * start), 1);
}

// A cut changes nothing but the momentum of the new bead.
TEST(PumpedJet, is_cut_at_known_times) {
  const Scene scene = straight_pumped(20 * mL_h, 20 * poise, 0.02 * cm);
  const double period = scene.config.nozzle->section() * 0.02 * cm / (20 * mL_h);
  auto simulation = build_simulation(scene);
  simulation->run_until(10.25 * period);
  EXPECT_EQ(simulation->statistics().insertions, 10U);
  EXPECT_NEAR(simulation->jet().fed_since / (10 * period), 1, 1e-15);
  const double v0 = scene.config.nozzle->section() * 0.02 * cm;
  EXPECT_NEAR(simulation->jet().volume[1] / (0.75 * v0), 1, 1e-12);
  for (std::size_t k = 2; k < simulation->jet().beads(); ++k)
    EXPECT_NEAR(simulation->jet().volume[k] / v0, 1, 1e-14) << k;
}

// A cut that comes late, at the end of a step, cuts what the link holds by then.
TEST(PumpedJet, holds_what_has_been_pumped_with_events_at_step_ends) {
  Scene scene = straight_pumped(20 * mL_h, 20 * poise, 0.02 * cm);
  scene.config.integrator.events = EventPlacement::step_end;
  scene.config.integrator.max_step = 1e-4;
  const double q = *scene.config.nozzle->flow_rate,
               start = scene.config.nozzle->section() * 0.02 * cm / 2;
  auto simulation = build_simulation(scene);
  simulation->run_until(10e-3);
  EXPECT_GT(simulation->statistics().insertions, 30U);
  EXPECT_NEAR(sum_from_one(simulation->jet().volume) / (start + q * 10e-3), 1, 1e-13);
}

TEST(PumpedJet, stops_when_fluid_piles_up) {
  Scene scene = straight_pumped(20 * mL_h, 20 * poise, 0.02 * cm);
  scene.config.field->strength = -1e4; // back to the nozzle
  auto simulation = build_simulation(scene);
  try {
    simulation->run_until(0.1);
    FAIL();
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("cannot carry Q"), std::string::npos) << e.what();
  }
}

// Every energy that a pump brings in has its account.
TEST(PumpedJet, has_a_budget_that_closes) {
  for (const bool softened : {false, true}) {
    Scene scene = jet_k(softened ? 0.02 * cm : 0.05 * cm, 0.4 * cm, 1e-6);
    if (!softened) scene.config.nozzle->flow_rate = 30 * mL_h;
    scene.config.coulomb->near_field = NearFieldForm::free_surface;
    scene.config.coulomb->softened_pairs = softened;
    scene.config.refinement.reset();
    scene.config.nozzle->nozzle_stress = 50;
    const FinishedRun run(scene, 3e-3, 1e-3);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 2e-7) << softened;
    EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 1e-7) << softened;
    EXPECT_NE(run.last().at("inflow_energy"), 0);
    EXPECT_NE(run.last().at("near_field_energy"), 0);
    EXPECT_NE(run.last().at("nozzle_charge_energy"), 0);
  }
}

TEST(PumpedJet, goes_on_from_a_checkpoint_with_the_same_bits) {
  const Scene scene = jet_k(0.02 * cm, 0.4 * cm);
  class Last final : public Observer {
  public:
    explicit Last(Checkpoint& last)
        : last_(last) {}
    void checkpoint(const Checkpoint& c) override { last_ = c; }

  private:
    Checkpoint& last_;
  };
  Checkpoint last;
  auto whole = build_simulation(scene);
  whole->make_checkpoints(3e-3);
  whole->add(std::make_unique<Last>(last));
  whole->run_until(4e-3);
  auto rest = build_simulation(scene);
  rest->make_checkpoints(3e-3);
  rest->restore(last);
  rest->run_until(4e-3);
  EXPECT_EQ(rest->jet().y, whole->jet().y);
  EXPECT_EQ(rest->jet().volume, whole->jet().volume);
}

} // namespace
} // namespace ehdjet
