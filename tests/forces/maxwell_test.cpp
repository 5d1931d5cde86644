#include "ehdjet/core/error.hpp"
#include "ehdjet/forces/maxwell.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "support/chain.hpp"
#include "support/march.hpp"
#include "support/units.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double G = 5e4 * dyn_cm2, mu = 20 * poise, tau = mu / G, l0 = 0.02 * cm;
const Vec3 direction{1. / 3, 2. / 3, -2. / 3};

/// One link whose length is prescribed while its upstream end moves along; y = {sigma}.
class PulledLink {
public:
  using OfTime = std::function<double(double)>;
  PulledLink(double viscosity, OfTime length, OfTime rate)
      : maxwell_(G, viscosity)
      , length_(std::move(length))
      , rate_(std::move(rate)) {}

  [[nodiscard]] double stress(std::string_view method, int steps, double t,
                              double start = 0) {
    Chain chain(2);
    FunctionSystem system(
        [&](double time, std::span<const double> y, std::span<double> rate) {
          const Vec3 drift(0.3, -0.2, 0.1); // of both ends: changes nothing
          chain.place(0, l0 * drift * time, l0 * drift);
          chain.place(1, l0 * drift * time + length_(time) * direction,
                      l0 * drift + rate_(time) * direction);
          stress_of(chain.columns())[1] = y[0];
          const std::vector<double> both = chain.stress_rates(maxwell_);
          EXPECT_EQ(both[0], 0);
          rate[0] = both[1];
        });
    return march(method, system, {start}, 0, t, steps).front();
  }

private:
  Maxwell maxwell_;
  OfTime length_, rate_;
};

struct Published {
  double drive, time, stress;
};

// l = l0 e^(rt): sigma = mu r (1 - e^(-t/tau))
TEST(Maxwell, under_a_constant_strain_rate_the_stress_approaches_viscosity_times_rate) {
  const Published values[] = {
      {100, tau / 4, 442.398433857190264}, {100, tau, 1264.24111765711536},
      {100, 5 * tau, 1986.52410600182907}, {2500, tau / 4, 11059.9608464297566},
      {2500, tau, 31606.0279414278839},    {2500, 5 * tau, 49663.1026500457266},
      {1e4, tau / 4, 44239.8433857190264}, {1e4, tau, 126424.111765711536},
      {1e4, 5 * tau, 198652.410600182907},
  };
  for (const auto& [r, t, stress] : values) {
    PulledLink link(
        mu, [r = r](double s) { return l0 * std::exp(r * s); },
        [r = r](double s) { return l0 * r * std::exp(r * s); });
    const int thousand_per_tau = static_cast<int>(std::lround(1000 * t / tau));
    const double exact = stress * dyn_cm2;
    // The method's error is (1/1000)^4/120 per tau.
    EXPECT_NEAR(link.stress("rk4", thousand_per_tau, t) / exact, 1, 1e-12) << r << " " << t;
    EXPECT_NEAR(link.stress("dop853", 40, t) / exact, 1, 1e-11) << r << " " << t;
  }
}

// l = l0 + v t: sigma = G e^(-(t+b)/tau) (Ei((t+b)/tau) - Ei(b/tau)), b = l0/v
TEST(Maxwell, under_a_constant_pulling_speed_the_stress_rises_and_decays) {
  const Published values[] = {
      {10, tau / 4, 2156.27847959620518},   {10, tau, 5676.8985661729753},
      {10, 5 * tau, 5566.13058973856002},   {100, tau / 4, 17787.2674829515008},
      {100, tau, 31763.3095422644203},      {100, 5 * tau, 11853.9450418658862},
      {1000, tau / 4, 76497.4843191986105}, {1000, tau, 76968.3142017094612},
      {1000, 5 * tau, 14122.1328105901291},
  };
  for (const auto& [speed, t, stress] : values) {
    const double v = speed * cm;
    PulledLink link(
        mu, [v](double s) { return l0 + v * s; }, [v](double) { return v; });
    const int thousand_per_tau = static_cast<int>(std::lround(1000 * t / tau));
    // At 1000 cm/s the link doubles its length within tau/20: h v/l = 1/50 in the first step.
    EXPECT_NEAR(link.stress("rk4", thousand_per_tau, t) / (stress * dyn_cm2), 1, 1e-9)
        << speed << " " << t;
    EXPECT_NEAR(link.stress("dop853", thousand_per_tau, t) / (stress * dyn_cm2), 1, 1e-12)
        << speed << " " << t;
  }
}

// A stretch too fast for relaxation, then rest: sigma = G ln 2 e^(-t/tau)
TEST(Maxwell, a_sudden_stretch_gives_the_logarithmic_strain_which_then_relaxes) {
  constexpr double never_relaxes = 1e30;
  PulledLink doubling(
      never_relaxes, [](double s) { return l0 * (1 + s); }, [](double) { return l0; });
  const double sudden = doubling.stress("dop853", 50, 1.0);
  EXPECT_NEAR(sudden / (34657.3590279972655 * dyn_cm2), 1, 1e-13);

  PulledLink resting(
      mu, [](double) { return 2 * l0; }, [](double) { return 0.0; });
  const double after_tau = resting.stress("dop853", 50, tau, sudden);
  const double after_ten = resting.stress("dop853", 500, 10 * tau, sudden);
  EXPECT_NEAR(after_tau / (12749.7298716976755 * dyn_cm2), 1, 1e-12);
  EXPECT_NEAR(after_ten / (1.57344166562429612 * dyn_cm2), 1, 1e-12);
}

TEST(Maxwell, rigid_motion_raises_no_stress) {
  Chain chain(6);
  const Vec3 spin(40, -70, 90), drift(3, -2, 1); // [1/s], [m/s]
  for (std::size_t k = 0; k < 6; ++k) {
    const double s = static_cast<double>(k);
    const Vec3 r = l0 * Vec3(s, std::sin(s), std::cos(2 * s));
    chain.place(k, r, drift + spin.cross(r));
  }
  Maxwell maxwell(G, mu);
  const std::vector<double> rate = chain.stress_rates(maxwell);
  // Relative to G |v|/l, of which the difference of two velocities is formed.
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(rate[k], 0, 8 * epsilon * G * 4 / l0) << k;
}

/// Six beads on a curve, all links different, with stresses of both signs.
Chain strained_chain(std::size_t first) {
  Chain chain(6);
  chain.first = first;
  for (std::size_t k = 0; k < 6; ++k) {
    const double s = static_cast<double>(k);
    chain.place(k, l0 * Vec3(s, std::sin(s), std::cos(2 * s)),
                Vec3(std::cos(s), std::sin(3 * s), s * s));
    stress_of(chain.columns())[k] = k < first ? 0.0 : 1e3 * (s - 2.5);
    chain.volume[k] = 1e-12 * (1 + s);
  }
  return chain;
}

TEST(Maxwell, pulls_with_the_cross_section_times_the_stress_along_the_link) {
  Chain chain = strained_chain(1);
  Maxwell maxwell(G, mu);
  const std::vector<Vec3> f = chain.force(maxwell);
  const auto r = chain.columns().position();
  const auto tension = [&](std::size_t k) -> Vec3 { // pi a^2 sigma t, pi a^2 = V/l
    const Vec3 d = r[k] - r[k - 1];
    return chain.volume[k] / d.norm() * stress_of(chain.columns())[k] * d.normalized();
  };
  const double round_off = 10 * epsilon * tension(5).norm();
  EXPECT_LE((f[0] - tension(1)).norm(), round_off);
  for (std::size_t k = 1; k < 5; ++k)
    EXPECT_LE((f[k] - (tension(k + 1) - tension(k))).norm(), round_off) << k;
  EXPECT_LE((f[5] + tension(5)).norm(), round_off);
}

TEST(Maxwell, internal_forces_sum_to_zero_with_and_without_an_embryo) {
  for (const std::size_t first : {1U, 2U}) {
    Chain chain = strained_chain(first);
    Maxwell maxwell(G, mu);
    const std::vector<Vec3> f = chain.force(maxwell);
    EXPECT_GT(f[0].norm(), 0);
    EXPECT_LE(sum(f).norm(), 10 * epsilon * sum_of_norms(f)) << first;
  }
}

TEST(Maxwell, an_embryo_is_passed_over_by_forces_and_rates) {
  Chain chain = strained_chain(2);
  Maxwell maxwell(G, mu);
  EXPECT_EQ(chain.force(maxwell)[1], Vec3::Zero());
  const std::vector<double> rate = chain.stress_rates(maxwell);
  EXPECT_EQ(rate[1], 0);
  const auto r = chain.columns().position(), v = chain.columns().velocity();
  const Vec3 d = r[2] - r[0];
  const double expected =
      G * (v[2] - v[0]).dot(d) / d.squaredNorm() - G / mu * stress_of(chain.columns())[2];
  EXPECT_NEAR(rate[2] / expected, 1, 20 * epsilon);
}

TEST(Maxwell, a_landed_bead_is_at_rest_for_the_link_below_it) {
  Chain chain = strained_chain(1);
  Maxwell maxwell(G, mu);
  const std::vector<double> moving = chain.stress_rates(maxwell);
  chain.landed = {{.bead = 3, .time = 0, .radius = 0}};
  std::vector<double> landed = chain.stress_rates(maxwell);
  const auto r = chain.columns().position(), v = chain.columns().velocity();
  const Vec3 d = r[4] - r[3];
  const double expected =
      G * v[4].dot(d) / d.squaredNorm() - G / mu * stress_of(chain.columns())[4];
  EXPECT_NEAR(landed[4] / expected, 1, 100 * epsilon);
  EXPECT_GT(std::abs(landed[4] / moving[4] - 1), 0.01);
  EXPECT_EQ(landed[5], moving[5]);
  chain.landed = {{.bead = 5, .time = 0, .radius = 0}}; // nothing below it
  landed = chain.stress_rates(maxwell);
  for (const std::size_t k : {1U, 2U, 3U, 4U}) EXPECT_EQ(landed[k], moving[k]) << k;
}

TEST(Maxwell, a_landed_bead_moves_with_the_plate_for_the_link_below_it) {
  Chain chain = strained_chain(1);
  Maxwell maxwell(G, mu);
  const std::vector<double> moving = chain.stress_rates(maxwell);
  chain.stage().plate_velocity = chain.columns().velocity()[3];
  chain.landed = {{.bead = 3, .time = 0, .radius = 0}};
  const std::vector<double> landed = chain.stress_rates(maxwell);
  for (const std::size_t k : {1U, 2U, 3U, 4U, 5U}) EXPECT_EQ(landed[k], moving[k]) << k;
}

TEST(Maxwell, a_fluid_without_elasticity_or_viscosity_is_a_contract_violation) {
  EXPECT_THROW(Maxwell(0, mu), ContractViolation);
  EXPECT_THROW(Maxwell(G, 0), ContractViolation);
  EXPECT_THROW(Maxwell(std::nan(""), mu), ContractViolation);
}

} // namespace
} // namespace ehdjet
