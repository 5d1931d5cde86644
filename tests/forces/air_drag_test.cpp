#include "ehdjet/core/constants.hpp"
#include "ehdjet/forces/air_drag.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "support/chain.hpp"
#include "support/march.hpp"

namespace ehdjet {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double rho_air = 1.21, nu = 1.511e-5;
constexpr double rho = 839.253525, charge_density = 14.67682018871869; // PVP jet, set J
constexpr double field = 9000 / 0.16, gravity = constants::standard_gravity;
constexpr std::array both_laws{DragLaw::anisotropic, DragLaw::tangential};

AirFlow still_air() {
  return {rho_air, nu, Vec3::Zero()};
}

struct Coefficients {
  double reynolds, normal, tangential;
};
// Marheineke & Wegener, evaluated apart from this program; eight to ten digits are given.
TEST(DragCoefficients, have_their_published_values) {
  for (const auto& [re, normal, tangential] : {Coefficients{0.01, 190.1835158, 102.8747836},
                                               {1, 5.42544541, 3.17465829},
                                               {10, 1.43689868, 0.71639622},
                                               {100, 0.70000000, 0.20000000},
                                               {1000, 0.56324555, 0.06324555}}) {
    const DragCoefficients c = drag_coefficients(DragLaw::anisotropic, re, re);
    EXPECT_NEAR(c.normal, normal, 5e-9 * std::max(1.0, 10 * normal)) << re;
    EXPECT_NEAR(c.tangential, tangential, 5e-9 * std::max(1.0, 10 * tangential)) << re;
  }
}

// Their three forms meet to 2e-5 at Re = 0.1, and to 7e-5 at Re = 100.
TEST(DragCoefficients, are_nearly_continuous) {
  for (const double re : {0.1, 100.0}) {
    const DragCoefficients a = drag_coefficients(DragLaw::anisotropic, re * (1 - 1e-12),
                                                 re * (1 - 1e-12)),
                           b = drag_coefficients(DragLaw::anisotropic, re, re);
    EXPECT_NEAR(a.normal / b.normal, 1, 2e-5) << re;
    EXPECT_NEAR(a.tangential / b.tangential, 1, 7e-5) << re;
  }
}

/// A straight thread of radius a along t, all beads with velocity v.
Chain thread(std::size_t beads, double a, double l, const Vec3& t, const Vec3& v) {
  Chain chain(beads);
  for (std::size_t k = 0; k < beads; ++k) {
    chain.place(k, static_cast<double>(k) * l * t, v);
    chain.volume[k] = pi * a * a * l;
    chain.mass[k] = rho * chain.volume[k];
  }
  return chain;
}

struct Terminal {
  double radius, across, along;
};
// Where the drag bears field and weight.
TEST(AirDrag, lets_a_straight_thread_fall_at_its_terminal_speed) {
  const double l = 2e-3;
  AirDrag drag(still_air(), DragLaw::anisotropic);
  for (const auto& [a, across, along] :
       {Terminal{4e-6, 0.59372164, 0.90385051}, Terminal{20e-6, 3.91323498, 6.43982657}}) {
    const double load = pi * a * a * (charge_density * field + rho * gravity);
    Chain falling = thread(3, a, l, Vec3::UnitY(), across * Vec3::UnitX());
    EXPECT_NEAR(-falling.force(drag)[1].x() / (load * l), 1, 2e-8) << a;
    Chain sliding = thread(3, a, l, Vec3::UnitX(), along * Vec3::UnitX());
    EXPECT_NEAR(-sliding.force(drag)[1].x() / (load * l), 1, 2e-8) << a;
  }
  const double a = 4e-6;
  Chain slow = thread(3, a, l, Vec3::UnitZ(), 0.01262313 * Vec3::UnitX());
  EXPECT_NEAR(-slow.force(drag)[1].x() / (pi * a * a * rho * gravity * l), 1, 5e-7);
}

// v' = -k v^1.19, k = 0.65 rho_air (2a/nu)^-0.81/(rho a)
TEST(AirDrag, slows_a_sliding_thread_by_the_tangential_law) {
  const double a = 4e-6, l = 1e-3;
  AirDrag drag(still_air(), DragLaw::tangential);
  FunctionSystem system([&](double, std::span<const double> y, std::span<double> rate) {
    Chain chain = thread(2, a, l, Vec3(1, 2, -2) / 3, y[0] * Vec3(1, 2, -2) / 3);
    const Vec3 f = chain.force(drag)[0] + chain.force(drag)[1];
    rate[0] = f.dot(Vec3(1, 2, -2) / 3) / chain.mass[1];
  });
  const ErrorScale scale{.rtol = 1e-12, .column_scale = {1}};
  EXPECT_NEAR(march_adaptively("dop853", system, {20}, 0, 1e-3, scale)[0], 10.4315704215,
              1e-9);
  EXPECT_NEAR(march_adaptively("dop853", system, {20}, 0, 5e-3, scale)[0], 1.39646123291,
              1e-9);
}

/// A crooked chain with velocities of some metres per second, more than a block of beads long.
Chain crooked(std::size_t beads) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  Chain chain(beads);
  Vec3 r = Vec3::Zero();
  for (std::size_t k = 0; k < beads; ++k) {
    chain.place(k, r, 5 * any());
    r += 1e-3 * any();
    chain.volume[k] = 1e-14 * std::exp(normal(random));
    chain.mass[k] = rho * chain.volume[k];
  }
  return chain;
}

// The same by hand, end by end.
TEST(AirDrag, adds_up_what_both_ends_of_every_link_feel) {
  for (const std::size_t beads : {2U, 64U, 65U, 150U}) {
    Chain chain = crooked(beads);
    for (const DragLaw law : both_laws) {
      const Vec3 u(1, -2, 0.5);
      AirDrag drag({rho_air, nu, u}, law);
      std::vector<Vec3> expected(beads, Vec3::Zero());
      const auto r = chain.columns().position(), v = chain.columns().velocity();
      for (std::size_t k = 1; k < beads; ++k) {
        const Vec3 d = r[k] - r[k - 1];
        const double l = d.norm(), a = std::sqrt(chain.volume[k] / (pi * l));
        for (const std::size_t end : {k - 1, k}) {
          const Vec3 w = v[end] - u, along = w.dot(d / l) * d / l, across = w - along;
          const auto c =
              drag_coefficients(law, 2 * a * across.norm() / nu, 2 * a * along.norm() / nu);
          expected[end] -=
              rho_air * a * l
              * (c.tangential * along.norm() * along + c.normal * across.norm() * across);
        }
      }
      const std::vector<Vec3> f = chain.force(drag);
      for (std::size_t k = 0; k < beads; ++k)
        EXPECT_LE((f[k] - expected[k]).norm(), 1e-13 * expected[k].norm()) << beads << k;
    }
  }
}

TEST(AirDrag, does_not_act_on_what_moves_with_the_air) {
  const Vec3 u(1, -2, 0.5);
  for (const DragLaw law : both_laws) {
    AirDrag drag({rho_air, nu, u}, law);
    Chain chain = crooked(100);
    for (std::size_t k = 0; k < chain.beads; ++k) chain.columns().velocity().set(k, u);
    for (const Vec3& f : chain.force(drag)) EXPECT_EQ(f, Vec3::Zero());
  }
}

TEST(AirDrag, is_the_same_in_any_frame_that_the_air_moves_with) {
  const Vec3 u(30, -2, 0.5);
  AirDrag in_wind({rho_air, nu, u}, DragLaw::anisotropic),
      at_rest(still_air(), DragLaw::anisotropic);
  Chain chain = crooked(100), moved = chain;
  for (std::size_t k = 0; k < chain.beads; ++k) moved.columns().velocity().add(k, u);
  const std::vector<Vec3> f = chain.force(at_rest), g = moved.force(in_wind);
  for (std::size_t k = 0; k < chain.beads; ++k)
    EXPECT_LE((f[k] - g[k]).norm(), 1e-13 * f[k].norm() * 10) << k;
}

TEST(AirDrag, takes_power_out_of_every_bead) {
  for (const DragLaw law : both_laws) {
    AirDrag drag(still_air(), law);
    Chain chain = crooked(1000);
    const std::vector<Vec3> f = chain.force(drag);
    for (std::size_t k = 0; k < chain.beads; ++k)
      EXPECT_LE(f[k].dot(chain.columns().velocity()[k]), 0) << k;
  }
}

TEST(AirDrag, has_a_force_per_length_that_does_not_depend_on_the_mesh) {
  const Vec3 t(2. / 3, 1. / 3, -2. / 3), v(3, 7, -2);
  for (const DragLaw law : both_laws) {
    AirDrag drag(still_air(), law);
    Vec3 coarse = Vec3::Zero();
    for (const std::size_t links : {1U, 10U, 1000U}) {
      const double length = 0.01;
      Chain chain = thread(links + 1, 4e-6, length / static_cast<double>(links), t, v);
      const Vec3 total = sum(chain.force(drag));
      if (links == 1) coarse = total;
      EXPECT_LE((total - coarse).norm(), 1e-12 * coarse.norm()) << links;
    }
  }
}

// Steps are implicit in the velocity of a bead: dF/dv of each bead by central differences.
TEST(AirDrag, knows_how_its_force_answers_to_a_velocity) {
  for (const double speed : {1e-3, 0.3, 20.0, 4000.0}) // all three forms of the law
    for (const DragLaw law : both_laws) {
      AirDrag drag(still_air(), law);
      Chain chain = crooked(40);
      for (double& v : chain.columns().flat.subspan(3 * chain.beads, 3 * chain.beads))
        v *= speed / 5;
      LinkDerivatives derivatives;
      derivatives.reset(chain.beads);
      drag.add_derivatives(chain.stage(), derivatives);
      for (std::size_t k = 0; k < chain.beads; ++k) {
        Mat3 differences;
        const Vec3 v = chain.columns().velocity()[k];
        const double h = 1e-5 * v.norm();
        for (int c = 0; c < 3; ++c) {
          const auto force_at = [&](double shift) {
            chain.columns().velocity().set(k, v + shift * Vec3::Unit(c));
            return chain.force(drag)[k];
          };
          differences.col(c) = (force_at(h) - force_at(-h)) / (2 * h);
        }
        chain.columns().velocity().set(k, v);
        EXPECT_LE((derivatives.drag[k] + differences).norm(), 1e-6 * differences.norm())
            << speed << " " << k;
        // What an implicit method may solve with: the drag never feeds a motion.
        const Eigen::SelfAdjointEigenSolver<Mat3> spectrum(derivatives.drag[k]);
        EXPECT_GE(spectrum.eigenvalues()[0], -1e-12 * spectrum.eigenvalues()[2]);
      }
    }
}

TEST(AirFlow, is_interpolated_over_x_and_stays_constant_beyond_its_ends) {
  const AirFlow air(
      rho_air, nu,
      AirProfile{.x = {0, 0.1, 0.3}, .ux = {1, 2, 2}, .uy = {0, 0, 4}, .uz = {-1, -1, 1}});
  EXPECT_EQ(air.velocity(-1), Vec3(1, 0, -1));
  EXPECT_LE((air.velocity(0.05) - Vec3(1.5, 0, -1)).norm(), 1e-15);
  EXPECT_LE((air.velocity(0.25) - Vec3(2, 3, 0.5)).norm(), 1e-15);
  EXPECT_EQ(air.velocity(0.3), Vec3(2, 4, 1));
  EXPECT_EQ(air.velocity(9), Vec3(2, 4, 1));
  // Beads see the air where they are.
  AirDrag drag(air, DragLaw::anisotropic);
  Chain chain = thread(3, 4e-6, 0.1, Vec3::UnitX(), Vec3(2, 0, -1));
  const std::vector<Vec3> f = chain.force(drag);
  EXPECT_LT(f[0].x(), 0);
  EXPECT_EQ(f[0].y(), 0);
  EXPECT_EQ(f[1], Vec3::Zero());
  EXPECT_GT(f[2].y(), 0);
  EXPECT_GT(f[2].z(), 0);
}

// rho_air l v^2 pi a^2/R, outwards, on every inner bead of a ring that runs around.
TEST(AirLift, pushes_a_ring_that_runs_along_itself_outwards) {
  constexpr std::size_t n = 200;
  constexpr double ring = 0.01, a = 1e-5, speed = 3;
  const double step = 2 * pi / n, chord = 2 * ring * std::sin(step / 2);
  Chain chain(n + 1);
  for (std::size_t k = 0; k <= n; ++k) {
    const double phi = step * static_cast<double>(k);
    chain.place(k, ring * Vec3(std::cos(phi), std::sin(phi), 0),
                speed * Vec3(-std::sin(phi), std::cos(phi), 0));
    chain.volume[k] = pi * a * a * chord;
  }
  AirLift lift(still_air());
  const std::vector<Vec3> f = chain.force(lift);
  const double expected = rho_air * chord * speed * speed * pi * a * a / ring;
  for (std::size_t k = 1; k < n; ++k)
    EXPECT_LE((f[k] - expected * chain.columns().position()[k] / ring).norm(),
              1e-10 * expected)
        << k;
  EXPECT_EQ(f[0], Vec3::Zero());
  EXPECT_EQ(f[n], Vec3::Zero());
}

} // namespace
} // namespace ehdjet
