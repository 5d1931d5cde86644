#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/forces/coulomb_force.hpp"
#include "ehdjet/forces/external_field.hpp"
#include "ehdjet/forces/gravity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/chain.hpp"
#include "support/units.hpp"

namespace ehdjet {
namespace {

using namespace test;

TEST(ExternalForces, the_field_acts_on_charges_and_gravity_on_masses_both_along_x) {
  Chain chain(3);
  chain.charge = {2, -3, 5}, chain.mass = {7, 11, 13};
  ExternalField field(1.5);
  Gravity gravity(9.5);
  const std::vector<Vec3> f = chain.force(field), g = chain.force(gravity);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(f[k], Vec3(1.5 * chain.charge[k], 0, 0)) << k;
    EXPECT_EQ(g[k], Vec3(9.5 * chain.mass[k], 0, 0)) << k;
  }
}

// y_j = e cos(kappa j): the centre bead feels (2 k q^2/l^3) e sum_p (1 - cos p kappa)/p^3.
TEST(CoulombForce, pushes_the_crest_of_a_sinusoidal_chain_outwards_by_a_lattice_sum) {
  constexpr int half = 200;
  constexpr double l = 0.02 * cm, q = 6.9e-2 * statC, amplitude = 1e-6 * l;
  CoulombForce coulomb(make_coulomb_solver({.solver = "direct"}));
  for (const double beads_per_wave : {2.0, 4.0, 10.0, 50.0}) {
    const double kappa = 2 * std::numbers::pi / beads_per_wave;
    Chain chain(2 * half + 1);
    double lattice = 0;
    for (int j = -half; j <= half; ++j) {
      const double aside = amplitude * std::cos(kappa * j);
      const auto k = static_cast<std::size_t>(j + half);
      chain.place(k, {j * l, 0.6 * aside, -0.8 * aside});
      chain.charge[k] = q;
    }
    for (int p = half; p >= 1; --p) lattice += (1 - std::cos(p * kappa)) / std::pow(p, 3);
    const Vec3 f = chain.force(coulomb)[half];
    const double exact = 2 * constants::coulomb * q * q / (l * l * l) * amplitude * lattice;
    // The next term of the expansion is of order (e/l)^2 = 1e-12.
    EXPECT_NEAR((0.6 * f.y() - 0.8 * f.z()) / exact, 1, 1e-9) << beads_per_wave;
    EXPECT_LE(std::abs(0.8 * f.y() + 0.6 * f.z()), 1e-9 * exact) << beads_per_wave;
  }
}

TEST(CoulombForce, reports_the_most_pairs_in_the_same_place_of_an_evaluation) {
  Chain chain(4);
  chain.place(0, {0, 0, 0}), chain.place(1, {1, 2, 3});
  chain.place(2, {1, 2, 3}), chain.place(3, {2, 1, 0});
  CoulombForce coulomb(make_coulomb_solver({.solver = "direct"}));
  const auto pairs_so_far = [&] {
    for (const Vec3& f : chain.force(coulomb)) EXPECT_TRUE(f.allFinite());
    return coulomb.report()->coincident_pairs;
  };
  EXPECT_EQ(pairs_so_far(), 1U);
  EXPECT_EQ(pairs_so_far(), 1U);
  chain.place(3, {1, 2, 3});
  EXPECT_EQ(pairs_so_far(), 3U);
  chain.place(3, {2, 1, 0}), chain.place(2, {0, 2, 0});
  EXPECT_EQ(pairs_so_far(), 3U);
}

} // namespace
} // namespace ehdjet
