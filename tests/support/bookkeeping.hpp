#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "support/scenes.hpp"

/// Mass, charge and volume of a jet against what has been inserted (model 5).
namespace ehdjet::test {

inline double sum_from_one(const std::vector<double>& values) {
  CompensatedSum sum;
  for (std::size_t k = 1; k < values.size(); ++k) sum += values[k];
  return sum;
}

/// Chain and deposit against what has been inserted, and all of that against the count.
inline void expect_balance(const JetState& jet, const Ledger& ledger) {
  const double bound = 1e-13;
  const auto expect = [&](const std::vector<double>& chain, double removed, double inserted,
                          double each) {
    EXPECT_NEAR((sum_from_one(chain) + removed) / inserted, 1, bound) << jet.time;
    EXPECT_NEAR(inserted / (static_cast<double>(ledger.inserted_beads) * each), 1, bound)
        << jet.time;
  };
  expect(jet.mass, ledger.removed_mass, ledger.inserted_mass, pvp::mass);
  expect(jet.charge, ledger.removed_charge, ledger.inserted_charge, pvp::charge);
  expect(jet.volume, ledger.removed_volume, ledger.inserted_volume, pvp::volume);
  EXPECT_EQ(jet.links() + ledger.removed_beads, ledger.inserted_beads) << jet.time;
}

/// Runs a PVP jet and checks the balance after every event.
inline void expect_balance_throughout(const Scene& scene, double end_time,
                                      std::size_t least_removed) {
  auto simulation = build_simulation(scene);
  std::vector<DepositedBead> deposit;
  simulation->add(std::make_unique<Deposit>(deposit));
  std::uint64_t events = 0;
  simulation->after_each_step([&](const Simulation& s) {
    const RunStatistics& n = s.statistics();
    if (n.insertions + n.releases + n.landings == events) return;
    events = n.insertions + n.releases + n.landings;
    expect_balance(s.jet(), s.ledger());
    EXPECT_EQ(n.insertions + 1, s.ledger().inserted_beads);
    EXPECT_EQ(n.insertions - n.releases, s.jet().has_embryo ? 1U : 0U);
    EXPECT_EQ(n.landings, s.ledger().removed_beads + s.jet().landed.size());
  });
  simulation->run_until(end_time);
  EXPECT_EQ(deposit.size(), simulation->ledger().removed_beads);
  EXPECT_GE(deposit.size(), least_removed);
  CompensatedSum mass;
  for (const DepositedBead& b : deposit) {
    mass += b.bead.mass;
    EXPECT_EQ(b.bead.position.x(), scene.config.collector->distance);
    EXPECT_LE(b.time, b.removal_time);
    EXPECT_GT(b.landing_radius, 0);
    EXPECT_GT(b.radius, 0);
  }
  EXPECT_EQ(double(mass), double(simulation->ledger().removed_mass));
  for (std::size_t i = 1; i < deposit.size(); ++i)
    EXPECT_LE(deposit[i - 1].removal_time, deposit[i].removal_time);
}

} // namespace ehdjet::test
