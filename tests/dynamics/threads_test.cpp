#include "ehdjet/core/parallel.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/forces/external_field.hpp"
#include "ehdjet/forces/gravity.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/near_field.hpp"
#include "ehdjet/forces/nozzle_thread.hpp"
#include "ehdjet/forces/surface_tension.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/scenes.hpp"

/// Local forces on long chains, which all threads compute.
namespace ehdjet {
namespace {

using namespace test;

constexpr std::size_t beads = 2 * parallel_from + 1001;

/// A coil with links of many lengths and beads of many masses.
JetState coil() {
  JetState jet = blank_jet(table_with_stress(), beads);
  for (std::size_t k = 0; k < beads; ++k) {
    const auto s = static_cast<double>(k);
    const double turn = 0.01 * s, wide = 0.02 + 1e-3 * std::sin(0.37 * s);
    jet.columns().position().set(k,
                                 {1e-5 * s, wide * std::cos(turn), wide * std::sin(turn)});
    jet.columns().velocity().set(k, {std::sin(s), std::cos(2 * s), std::sin(3 * s)});
    stress_of(jet.columns())[k] = 1e3 * (1 + std::sin(0.1 * s));
    jet.mass[k] = pvp::mass * (1.5 + std::sin(s)),
    jet.volume[k] = jet.mass[k] / pvp::density;
    jet.charge[k] = pvp::charge * (1.5 + std::cos(s));
  }
  return jet;
}

std::unique_ptr<JetDynamics> all_local_terms(bool softened) {
  auto dynamics = std::make_unique<JetDynamics>();
  dynamics->hold({.first = true, .last = false});
  dynamics->add(std::make_unique<ExternalField>(5e4));
  dynamics->add(std::make_unique<Gravity>(pvp::gravity));
  dynamics->add(std::make_unique<NearField>(
      NearField::Options{.kind = NearFieldKind::free_surface, .softened = softened}));
  dynamics->add(
      std::make_unique<NozzleThread>(pvp::charge / pvp::link_length, 1e-3, pvp::radius));
  dynamics->add(std::make_unique<BendingSurfaceTension>(pvp::surface_tension));
  dynamics->add(std::make_unique<LineSurfaceTension>(pvp::surface_tension));
  dynamics->add(std::make_unique<Maxwell>(pvp::modulus, pvp::viscosity));
  return dynamics;
}

std::vector<double> rates(JetDynamics& dynamics, const JetState& jet,
                          BeadRange targets = {}) {
  std::vector<double> rate(jet.y.size());
  dynamics.evaluate(0, jet.y, rate, targets, {});
  return rate;
}

TEST(Threads, rates_have_the_same_bits_for_any_number_of_them) {
  const JetState jet = coil();
  for (const bool softened : {false, true}) {
    const auto dynamics = all_local_terms(softened);
    dynamics->bind(jet);
    std::vector<double> alone;
    for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
      const ThreadCount count(threads);
      const std::vector<double> all = rates(*dynamics, jet);
      if (threads == 1) alone = all;
      EXPECT_TRUE(all == alone) << threads;
    }
  }
}

// A part of the chain that is too short for threads has the rates that it has in the whole.
TEST(Threads, rates_of_a_long_chain_are_those_of_its_parts) {
  const JetState jet = coil();
  const auto dynamics = all_local_terms(false);
  dynamics->bind(jet);
  const ThreadCount count(3);
  const std::vector<double> all = rates(*dynamics, jet);
  constexpr std::size_t length = 3000;
  for (std::size_t begin = 0; begin < beads; begin += length) {
    const std::size_t end = std::min(begin + length, beads);
    const std::vector<double> part = rates(*dynamics, jet, {begin, end});
    for (std::size_t c = 0; c < 7; ++c)
      for (std::size_t k = begin; k < end; ++k)
        ASSERT_EQ(part[c * beads + k], all[c * beads + k]) << c << ' ' << k;
  }
}

// A bead beyond the collector acts from where it crossed: that state is a copy.
TEST(Threads, beads_are_absorbed_alike_by_any_number_of_them) {
  JetState jet = coil();
  jet.absorbing_plane = 1e-5 * (beads - 10.5);
  const auto dynamics = all_local_terms(false);
  dynamics->bind(jet);
  std::vector<double> alone;
  for (const std::size_t threads : {1U, 2U, 3U}) {
    const ThreadCount count(threads);
    const std::vector<double> all = rates(*dynamics, jet);
    if (threads == 1) alone = all;
    EXPECT_TRUE(all == alone) << threads;
    const JetColumns<const double> columns{all, beads};
    EXPECT_EQ(columns.velocity()[beads - 1], columns.velocity()[beads - 11]);
  }
}

} // namespace
} // namespace ehdjet
