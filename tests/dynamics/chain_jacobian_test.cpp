#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/insertion.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/surface_tension.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "support/jacobian.hpp"
#include "support/stress.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr Nozzle turning{
    .fluid_velocity = 0.7, .amplitude = 0.5, .angular_frequency = 2, .phase = 0.4};

std::shared_ptr<const Inflow> turning_inflow() {
  return std::make_shared<EmbryoInflow>(turning,
                                        EmbryoInflow::Rule{.link_length = 0.1, .born = {}});
}

/// Dashpots along the links, F = c (w.t) t, and drag on the beads, F = -b (1 + |v|^2) v.
class Dashpots final : public ForceTerm {
public:
  Dashpots(double dashpot, double drag)
      : c_(dashpot)
      , b_(drag) {}
  [[nodiscard]] std::string_view name() const override { return "dashpots"; }
  void add_force(const Stage& stage, Vec3View force) override {
    const Links& links = stage.links();
    const auto v = stage.columns.velocity();
    for (std::size_t k = links.first; k <= links.last; ++k) {
      const std::size_t up = links.upstream(k);
      const Vec3 t = links.vector(k) / links.length[k];
      const Vec3 pull = c_ * (v[k] - v[up]).dot(t) * t;
      force.add(k, -pull), force.add(up, pull);
    }
    for (std::size_t k = 0; k < stage.beads(); ++k)
      force.add(k, -b_ * (1 + v[k].squaredNorm()) * v[k]);
  }
  void add_derivatives(const Stage& stage, LinkDerivatives& out) override {
    const Links& links = stage.links();
    const auto v = stage.columns.velocity();
    for (std::size_t k = links.first; k <= links.last; ++k) {
      const Vec3 d = links.vector(k), t = d / links.length[k];
      const Vec3 w = v[k] - v[links.upstream(k)];
      const Mat3 along = t * t.transpose();
      out.add_damping(k, c_ * along);
      // d/dd of (w.d) d/l^2
      out.add_pull(k,
                   c_ / links.length[k]
                       * (t * w.transpose() + w.dot(t) * (Mat3::Identity() - 2 * along)));
    }
    for (std::size_t k = 0; k < stage.beads(); ++k)
      out.add_drag(
          k,
          b_ * ((1 + v[k].squaredNorm()) * Mat3::Identity() + 2 * v[k] * v[k].transpose()));
  }

private:
  double c_, b_; // [N s/m]
};

TEST(ChainJacobian, has_damping_and_drag) {
  for (const bool with_stress : {false, true}) {
    JetDynamics dynamics;
    if (with_stress) dynamics.add(std::make_unique<Maxwell>(3, 2));
    dynamics.add(std::make_unique<Dashpots>(0.9, 0.4));
    expect_same(dynamics, (with_stress ? BentJet(6) : BentJet(6, BeadTable::basic())).jet,
                {});
    dynamics.hold({.first = true, .last = true});
    expect_same(
        dynamics, (with_stress ? BentJet(6) : BentJet(6, BeadTable::basic())).jet,
        {{0, 5}, with_stress ? std::vector<std::size_t>{0} : std::vector<std::size_t>{}});
  }
}

TEST(ChainJacobian, is_what_the_local_forces_answer) {
  for (const std::size_t n : {2U, 3U, 7U}) {
    JetDynamics dynamics;
    dynamics.add(std::make_unique<Maxwell>(3, 2));
    dynamics.add(std::make_unique<LineSurfaceTension>(0.8));
    expect_same(dynamics, BentJet(n).jet, {});
  }
}

TEST(ChainJacobian, allows_for_compression) {
  JetDynamics dynamics;
  dynamics.add(std::make_unique<Maxwell>(3, 2));
  BentJet bent(7);
  for (double& sigma : test::stress_of(bent.jet.columns())) sigma *= -1;
  expect_same(dynamics, bent.jet, {});
}

TEST(ChainJacobian, does_without_stress) {
  JetDynamics dynamics;
  dynamics.add(std::make_unique<LineSurfaceTension>(0.8));
  expect_same(dynamics, BentJet(6, BeadTable::basic()).jet, {});
}

TEST(ChainJacobian, leaves_held_beads_alone) {
  for (const HeldEnds ends : {HeldEnds{true, false}, {false, true}, {true, true}}) {
    JetDynamics dynamics;
    dynamics.add(std::make_unique<Maxwell>(3, 2));
    dynamics.hold(ends);
    Held held;
    if (ends.first) held = {{0}, {0}};
    if (ends.last) held.beads.push_back(6); // its link stretches with the bead above
    expect_same(dynamics, BentJet(7).jet, held);
  }
}

// The bead after an embryo hangs on bead 0; a landed bead rests whatever its velocity on record.
TEST(ChainJacobian, knows_embryos_and_landed_beads) {
  JetDynamics dynamics;
  dynamics.add(std::make_unique<Maxwell>(3, 2));
  dynamics.add(std::make_unique<LineSurfaceTension>(0.8));
  dynamics.set_inflow(turning_inflow());
  BentJet bent(8);
  bent.jet.has_embryo = true;
  bent.jet.landed = {{.bead = 4}, {.bead = 7}};
  dynamics.bind(bent.jet);
  dynamics.prescribe(0.3, bent.jet.y);
  expect_same(dynamics, bent.jet, {{0, 1, 4, 7}, {0, 1, 4, 7}});
}

TEST(ChainJacobian, takes_the_papers_surface_tension_as_on_a_straight_chain) {
  JetDynamics dynamics;
  dynamics.add(std::make_unique<BendingSurfaceTension>(0.8));
  JetState jet = BentJet(7, BeadTable::basic()).jet;
  const Vec3 direction(1. / 3, 2. / 3, -2. / 3);
  double at = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    jet.columns().position().set(k, at * direction);
    at += 0.5 + 0.1 * static_cast<double>(k % 3);
  }
  expect_same(dynamics, jet, {});
}

// df/dt at constant y is the part of it that the nozzle's motion brings about.
TEST(ChainJacobian, knows_how_the_nozzle_moves) {
  for (const bool embryo : {false, true}) {
    JetDynamics dynamics;
    dynamics.add(std::make_unique<Maxwell>(3, 2));
    dynamics.add(std::make_unique<LineSurfaceTension>(0.8));
    dynamics.add(std::make_unique<Dashpots>(0.9, 0.4));
    dynamics.set_inflow(turning_inflow());
    BentJet bent(5);
    bent.jet.has_embryo = embryo;
    dynamics.bind(bent.jet);
    std::vector<double>& y = bent.jet.y;
    const double t = 0.3, h = 1e-5;
    std::vector<double> later(y.size()), earlier(y.size()), rate(y.size(), 0.0);
    dynamics.prescribe(t + h, y);
    dynamics.evaluate(t + h, y, later);
    dynamics.prescribe(t - h, y);
    dynamics.evaluate(t - h, y, earlier);
    dynamics.prescribe(t, y);
    dynamics.stiff_part()->linearize(t, y);
    dynamics.stiff_part()->add_time_derivative(2, rate);
    double largest = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      EXPECT_NEAR(rate[i], (later[i] - earlier[i]) / h, 1e-7) << i;
      largest = std::max(largest, std::abs(rate[i]));
    }
    EXPECT_GT(largest, 1);
  }
}

// However stiff: G and mu over thirty decades, and a step that is nothing or endless.
TEST(ChainJacobian, solves_without_overflow) {
  for (const auto& [modulus, viscosity] :
       {std::pair{1e12, 1e-9}, {1e12, 1e300}, {1e-12, 1e-12}, {1e12, 2.0}})
    for (const double eta : {1e-15, 1e-6, 1.0, 1e6}) {
      if (eta * modulus / (1 + eta * modulus / viscosity) * eta > 1e14) continue;
      JetDynamics dynamics;
      dynamics.add(std::make_unique<Maxwell>(modulus, viscosity));
      const BentJet bent(6);
      dynamics.bind(bent.jet);
      dynamics.stiff_part()->linearize(0, bent.jet.y);
      dynamics.stiff_part()->factorize(eta);
      std::vector<double> x(bent.jet.y.size(), 1.0);
      dynamics.stiff_part()->solve(x);
      for (const double v : x) EXPECT_TRUE(std::isfinite(v)) << modulus << " " << eta;
    }
}

TEST(ChainJacobian, rates_are_those_of_a_uniform_chain) {
  constexpr std::size_t n = 9;
  const double l = 0.2, volume = 0.01, mass = 0.03, modulus = 5, viscosity = 100;
  JetState jet;
  jet.table = test::table_with_stress();
  jet.y.assign(7 * n, 0.0);
  jet.mass.assign(n, mass), jet.volume.assign(n, volume), jet.charge.assign(n, 0.0);
  for (std::size_t k = 0; k < n; ++k)
    jet.columns().position().set(k, {l * static_cast<double>(k), 0, 0});
  JetDynamics dynamics;
  dynamics.add(std::make_unique<Maxwell>(modulus, viscosity));
  dynamics.bind(jet);
  dynamics.stiff_part()->linearize(0, jet.y);
  const auto modes = dynamics.stiff_part()->fastest_modes();
  EXPECT_NEAR(modes[0].real(), -modulus / viscosity, 1e-12);
  EXPECT_NEAR(std::abs(modes[1]), 2 * std::sqrt(modulus * volume / (mass * l * l)), 1e-9);
  EXPECT_NEAR(modes[1].real(), -modulus / viscosity / 2, 1e-12);
  EXPECT_EQ(modes[2], 0.0);
}

} // namespace
} // namespace ehdjet
