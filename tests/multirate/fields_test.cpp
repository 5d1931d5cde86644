#include "ehdjet/multirate/extrapolated_field.hpp"
#include "ehdjet/multirate/predictor.hpp"
#include "ehdjet/multirate/projected_field.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

// What the two parts of a jet know of each other, one piece at a time.
namespace ehdjet {
namespace {

/// A stage of beads with charges 1, 2, 3, ... [C].
class Charged {
public:
  explicit Charged(std::size_t beads)
      : y_(6 * beads)
      , mass_(beads, 1.0)
      , charge_(beads) {
    for (std::size_t k = 0; k < beads; ++k) charge_[k] = static_cast<double>(k + 1);
    stage_.columns = {y_, beads}, stage_.mass = mass_, stage_.charge = charge_;
  }
  /// The forces of a term at time t, over the charges.
  std::vector<Vec3> field(ForceTerm& term, double t, BeadRange targets = {}) {
    const std::size_t n = mass_.size();
    std::vector<double> f(3 * n);
    const std::span<double> all(f);
    const Vec3View force{all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)};
    stage_.time = t, stage_.targets = targets.within(n);
    term.add_force(stage_, force);
    std::vector<Vec3> out(n);
    for (std::size_t k = 0; k < n; ++k) out[k] = force[k] / charge_[k];
    return out;
  }

private:
  std::vector<double> y_, mass_, charge_;
  Stage stage_;
};

/// x, y, z of each bead: a + b t + 10 k + direction.
std::vector<double> linear_field(std::size_t beads, double t, double slope = 3e5) {
  std::vector<double> e(3 * beads);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < beads; ++k)
      e[c * beads + k] =
          7 + slope * t + 10 * static_cast<double>(k) + static_cast<double>(c);
  return e;
}

TEST(ExtrapolatedField, is_exact_for_a_field_that_is_linear_in_time) {
  ExtrapolatedField field;
  Charged chain(3);
  EXPECT_FALSE(field.is_known());
  EXPECT_EQ(chain.field(field, 1e-5)[1].norm(), 0);
  field.learn(0, linear_field(3, 0), 3);
  EXPECT_NEAR(chain.field(field, 5e-6)[1].x(), linear_field(3, 0)[1], 1e-12);
  for (const double t : {1e-5, 2e-5, 2.7e-5}) {
    field.learn(t, linear_field(3, t), 3);
    const auto e = chain.field(field, t + 6e-6);
    const auto exact = linear_field(3, t + 6e-6);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(e[k].x(), exact[k], 1e-11);
      EXPECT_NEAR(e[k].z(), exact[6 + k], 1e-11);
    }
  }
}

// The slope from two times that are close to each other would be mostly noise.
TEST(ExtrapolatedField, does_not_take_its_slope_from_times_that_are_too_close) {
  ExtrapolatedField field;
  Charged chain(2);
  const auto noisy = [](double t, double noise) {
    auto e = linear_field(2, t);
    for (double& v : e) v += noise;
    return e;
  };
  field.learn(0, noisy(0, 0), 2);
  field.learn(1e-5, noisy(1e-5, 0), 2);
  field.learn(1.1e-5, noisy(1.1e-5, 0.01), 2); // replaces the value at 10 us
  const double exact = linear_field(2, 2e-5)[1];
  EXPECT_NEAR(chain.field(field, 2e-5)[1].x(), exact, 0.03); // 0.1 from the close pair
  ExtrapolatedField fresh;
  fresh.learn(0, noisy(0, 0), 2);
  fresh.learn(1e-6, noisy(1e-6, 0.01), 2); // one value only, the last one
  EXPECT_NEAR(chain.field(fresh, 9e-6)[1].x(), noisy(1e-6, 0.01)[1], 1e-12);
}

TEST(ExtrapolatedField, a_new_bead_has_the_past_of_the_bead_below_it) {
  ExtrapolatedField field;
  field.learn(0, linear_field(2, 0), 2);
  field.learn(1e-5, linear_field(2, 1e-5), 2);
  // Bead 1 becomes bead 2. The new one feels 4 V/m more than it does.
  auto now = linear_field(3, 2e-5);
  for (std::size_t c = 0; c < 3; ++c) {
    now[3 * c + 2] = linear_field(2, 2e-5)[2 * c + 1];
    now[3 * c + 1] = now[3 * c + 2] + 4;
  }
  field.learn(2e-5, now, 3);
  Charged chain(3);
  const auto e = chain.field(field, 3e-5);
  const auto exact = linear_field(2, 3e-5);
  EXPECT_NEAR(e[2].x(), exact[1], 1e-11);
  EXPECT_NEAR(e[1].x(), exact[1] + 4, 1e-11);
}

TEST(ExtrapolatedField, charges_that_become_distant_are_added_to_all_that_is_known) {
  ExtrapolatedField field;
  for (const double t : {0.0, 1e-5}) field.learn(t, linear_field(4, t), 4);
  const std::vector<double> more(3 * 3, 5.0);
  field.add_to_past(more, 3); // the last bead leaves
  Charged chain(4);
  const auto e = chain.field(field, 3e-5);
  EXPECT_NEAR(e[2].y(), linear_field(4, 3e-5)[4 + 2] + 5, 1e-11);
  EXPECT_EQ(e[3].norm(), 0);
}

/// A polynomial of degree 9 in time is integrated exactly by five of Gauss' nodes.
constexpr std::array<std::array<double, 2>, 5> gauss{
    {{0.046910077030668004, 0.11846344252809454},
     {0.23076534494715845, 0.23931433524968324},
     {0.5, 0.28444444444444444},
     {0.76923465505284155, 0.23931433524968324},
     {0.95308992296933200, 0.11846344252809454}}};

/// The projection over [t0, t0 + h] of a field that acts on the second of three beads and behind.
ProjectedField project(double t0, double h, const std::function<double(double)>& field,
                       std::size_t nodes = 400) {
  ProjectedField projected;
  projected.begin(t0, h, 1, 2);
  for (std::size_t i = 0; i < nodes; ++i)
    for (const auto& [place, weight] : gauss) {
      const double s = (static_cast<double>(i) + place) / static_cast<double>(nodes);
      const double e = field(t0 + s * h);
      projected.add(s, weight / static_cast<double>(nodes),
                    std::vector<double>{e, 2 * e, -e, 0, e, 3 * e});
    }
  return projected;
}

TEST(ProjectedField, is_exact_for_cubics) {
  const auto cubic = [](double t) { return 1 + t * (2 + t * (-3 + 4 * t)); };
  ProjectedField projected = project(0.5, 2, cubic, 1);
  Charged chain(3);
  for (const double t : {0.5, 1.1, 2.5}) {
    const auto e = chain.field(projected, t);
    EXPECT_EQ(e[0].norm(), 0); // not downstream
    EXPECT_NEAR(e[1].x(), cubic(t), 1e-12);
    EXPECT_NEAR(e[2].x(), 2 * cubic(t), 1e-12);
    EXPECT_NEAR(e[1].y(), -cubic(t), 1e-12);
    EXPECT_NEAR(e[2].z(), 3 * cubic(t), 1e-11);
  }
  const auto part = chain.field(projected, 1.1, {2, 3});
  EXPECT_EQ(part[1].norm(), 0);
  EXPECT_NEAR(part[2].x(), 2 * cubic(1.1), 1e-12);
}

// The charge at the nozzle grows in ramps. What they do to a bead over a step is kept, whatever the
// stages of the step see of them.
TEST(ProjectedField, keeps_the_impulse_and_the_first_moments_of_a_staircase) {
  constexpr double h = 3e-4, period = 7.7e-5, ramp = 3.8e-5;
  const auto staircase = [](double t) {
    const double steps = std::floor(t / period);
    return steps + std::min(1.0, (t - steps * period) / ramp);
  };
  ProjectedField projected = project(0, h, staircase);
  Charged chain(3);
  for (const int power : {0, 1, 2, 3}) {
    double exact = 0, kept = 0;
    constexpr std::size_t cells = 4000;
    for (std::size_t i = 0; i < cells; ++i)
      for (const auto& [place, weight] : gauss) {
        const double s = (static_cast<double>(i) + place) / cells;
        exact += weight / cells * staircase(s * h) * std::pow(s, power);
        kept += weight / cells * chain.field(projected, s * h)[1].x() * std::pow(s, power);
      }
    EXPECT_NEAR(kept / exact, 1, 2e-5) << power;
  }
}

TEST(ProjectedField, adds_the_acceleration_that_its_force_gives) {
  ProjectedField projected = project(
      0, 1, [](double t) { return 1 + t; }, 1);
  const std::vector<double> charge{1, 2, 3}, inverse_mass{1, 0.5, 0.25};
  std::vector<double> rate(9);
  const std::span<double> all(rate);
  projected.add_acceleration(0.5, -2, charge, inverse_mass,
                             {all.subspan(0, 3), all.subspan(3, 3), all.subspan(6, 3)});
  EXPECT_EQ(rate[0], 0);
  EXPECT_NEAR(rate[1], -2 * 2 * 0.5 * 1.5, 1e-12);
  EXPECT_NEAR(rate[2], -2 * 3 * 0.25 * 2 * 1.5, 1e-12);
  projected.clear();
  Charged chain(3);
  EXPECT_EQ(chain.field(projected, 0.5)[2].norm(), 0);
}

TEST(Predictor, is_exact_for_beads_whose_acceleration_is_linear_in_time) {
  constexpr std::size_t n = 5;
  constexpr double start = 2e-3, s = 3e-4;
  JetState jet = blank_jet(BeadTable::basic(), n);
  jet.time = start;
  std::vector<double> rate(jet.y.size()), jerk(jet.y.size());
  const auto number = [](std::size_t c, std::size_t k) {
    return static_cast<double>(10 * c + k);
  };
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t r = c * n + k, v = (c + 3) * n + k;
      jet.y[r] = number(c, k), jet.y[v] = 1e2 * number(c, k) + 1;
      rate[r] = jet.y[v], rate[v] = 1e5 * (1 + number(c, k)), jerk[v] = 1e9 * number(c, k);
    }
  for (std::size_t c = 0; c < 6; ++c) rate[c * n + 4] = jerk[c * n + 4] = 0; // bead 4 rests
  Predictor predictor;
  predictor.start(jet, rate, jerk);
  std::vector<double> places(3 * 3);
  const std::span<double> all(places);
  predictor.places(start + s, 2, {all.subspan(0, 3), all.subspan(3, 3), all.subspan(6, 3)});
  const double q = number(1, 3), v0 = 1e2 * q + 1, a0 = 1e5 * (1 + q), j = 1e9 * q;
  EXPECT_NEAR(places[3 + 1], q + s * (v0 + s * (a0 / 2 + s * j / 6)), 1e-13);
  EXPECT_EQ(places[2], jet.y[4]);

  predictor.lead(3, 2); // the last two of an inner chain of four beads
  std::vector<double> inner(6 * 4, -1.0);
  predictor.prescribe(start + s, {inner, 4});
  EXPECT_EQ(inner[1], -1);
  EXPECT_NEAR(inner[4 + 2], places[3 + 1], 1e-15);
  EXPECT_NEAR(inner[4 * 4 + 2], v0 + s * (a0 + s * j / 2), 1e-9);
}

} // namespace
} // namespace ehdjet
