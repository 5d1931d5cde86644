#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// The larger of two, or a number that is none.
double larger(double a, double b) {
  return b <= a ? a : b;
}

class GoldenChains : public testing::TestWithParam<const char*> {
protected:
  GoldenChain golden{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Ends, GoldenChains, testing::Values("free", "held"));

// An 8th-order integration by other code, to be trusted to 11 digits. Norms: positions by the link
// length, velocities and stresses by their largest value along the chain.
TEST_P(GoldenChains, move_as_in_an_independent_computation) {
  constexpr double trusted = 1e-11;
  for (const std::string method : {"dop853", "dormand-prince"}) {
    integrate(golden.scene, method, 1e-12);
    for (std::size_t i = 1; i < golden.times(); ++i) {
      const auto simulation = run(golden.scene, golden.time(i));
      const auto c = simulation->jet().columns();
      double position = 0, velocity = 0, stress = 0, fastest = 0, strongest = 0;
      for (std::size_t k = 0; k < golden.size(); ++k) {
        position = larger(position, (c.position()[k] - golden.position(i, k)).norm());
        velocity = larger(velocity, (c.velocity()[k] - golden.velocity(i, k)).norm());
        fastest = larger(fastest, golden.velocity(i, k).norm());
      }
      for (std::size_t k = 1; k < golden.size(); ++k) {
        stress = larger(stress, std::abs(stress_of(c)[k] - golden.stress(i, k)));
        strongest = larger(strongest, std::abs(golden.stress(i, k)));
      }
      EXPECT_LE(position, trusted * pvp::link_length) << method << " " << golden.time(i);
      EXPECT_LE(velocity, trusted * fastest) << method << " " << golden.time(i);
      EXPECT_LE(stress, trusted * strongest) << method << " " << golden.time(i);
    }
  }
}

TEST_P(GoldenChains, keep_a_held_bead_where_it_is) {
  const auto simulation = run(golden.scene, 1e-4);
  const bool held = golden.scene.config.chain->fixed == FixedEnds::first;
  EXPECT_EQ(simulation->jet().columns().position()[0] == golden.position(0, 0), held);
  EXPECT_EQ(simulation->jet().columns().velocity()[0] == Vec3::Zero(), held);
}

/// |r - r_ref|_2 over the whole free chain at 1e-4 s, in link lengths.
double error_of(const std::string& method, double step) {
  GoldenChain golden("free");
  constexpr std::size_t at = 2;
  EXPECT_EQ(golden.time(at), 1e-4);
  integrate_with_fixed_steps(golden.scene, method, step);
  const auto simulation = run(golden.scene, golden.time(at));
  double squares = 0;
  for (std::size_t k = 0; k < golden.size(); ++k)
    squares +=
        (simulation->jet().columns().position()[k] - golden.position(at, k)).squaredNorm();
  return std::sqrt(squares) / pvp::link_length;
}

struct Published {
  std::string method;
  double step, error;
};

TEST(GoldenChain, errors_of_fixed_steps_are_those_of_the_same_methods_elsewhere) {
  const Published rows[] = {
      {"euler", 5e-8, 1.836e-3},
      {"heun", 5e-7, 8.459e-5},
      {"rk4", 1e-5, 1.156e-4},
      {"rk4", 5e-6, 7.664e-6},
      {"rk4", 2.5e-6, 4.950e-7},
      {"rk4", 1.25e-6, 3.147e-8},
      {"dormand-prince", 1e-5, 2.881e-6},
      {"dormand-prince", 5e-6, 8.156e-8},
      {"dormand-prince", 2.5e-6, 2.262e-9},
  };
  for (const auto& [method, step, error] : rows)
    EXPECT_NEAR(error_of(method, step) / error, 1, 0.02) << method << " " << step;
}

TEST(GoldenChain, every_method_converges_at_its_order) {
  struct Row {
    std::string method;
    double step, order;
  };
  // Published slopes over the same steps: 1.000, 1.993, 3.975, 5.17.
  for (const auto& [method, step, order] :
       {Row{"euler", 1e-7, 1}, Row{"heun", 1e-6, 2}, Row{"rk4", 2.5e-6, 4},
        Row{"dormand-prince", 5e-6, 5.17}})
    EXPECT_NEAR(std::log2(error_of(method, step) / error_of(method, step / 2)), order, 0.1)
        << method;
}

} // namespace
} // namespace ehdjet
