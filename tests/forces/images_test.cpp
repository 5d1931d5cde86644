#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/forces/images.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "support/chain.hpp"

// Image charges in conducting plates (model 3.2).
namespace ehdjet {
namespace {

using namespace test;

constexpr double h = 0.16, q = 1e-11;
const Mirrors collector{.distance = h}, plates{.distance = h, .both_plates = true};

struct Published {
  double u, plates, collector;
};
// psi1 in closed form; the collector alone is k_C q^2/(4 (h - x)^2).
const Published rows[] = {{0.1, -8.73396583625266e-10, 1.08356864720392e-11},
                          {0.25, -1.28629503329925e-10, 1.56033885197364e-11},
                          {0.5, 0, 3.51076241694069e-11},
                          {0.9, 8.73396583625266e-10, 8.77690604235173e-10}};

TEST(OwnImages, of_a_point_charge_have_closed_forms) {
  for (const Published& row : rows) {
    const MirroredPiece point{.charge = q, .x = row.u * h};
    EXPECT_NEAR(own_image_force(point, collector) / row.collector, 1, 1e-14) << row.u;
    EXPECT_NEAR(own_image_force(point, plates), row.plates, 1e-14 * 1e-9) << row.u;
  }
}

// The sum over the images of a point charge, one by one.
TEST(OwnImages, of_a_point_charge_are_the_sum_over_all_of_them) {
  for (const double u : {0.02, 0.3, 0.77}) {
    double sum = 0;
    for (int i = -20000; i <= 20000; ++i) {
      const double d = 2 * u * h - 2 * h * i; // from -q at 2 h i - x
      sum -= constants::coulomb * q * q / (d * std::abs(d));
    }
    EXPECT_NEAR(own_image_force({.charge = q, .x = u * h}, plates) / sum, 1, 1e-8) << u;
  }
}

// A trial step that is rejected later may have put it anywhere, where trigamma has poles or no value.
TEST(OwnImages, of_a_charge_beyond_the_plates_are_those_at_them) {
  const MirroredPiece piece{.charge = q, .x = 2 * h, .length = 4e-3, .radius = 1e-5};
  const double beyond = own_image_force(piece, plates);
  EXPECT_TRUE(std::isfinite(beyond));
  for (const double x : {3 * h, 1e200})
    EXPECT_NEAR(
        own_image_force({.charge = q, .x = x, .length = 4e-3, .radius = 1e-5}, plates)
            / beyond,
        1, 1e-6)
        << x;
  for (const double x : {-h, -2 * h, -1e200})
    EXPECT_NEAR(
        own_image_force({.charge = q, .x = x, .length = 4e-3, .radius = 1e-5}, plates)
            / -beyond,
        1, 1e-6)
        << x;
}

TEST(OwnImages, of_a_piece_of_jet_stay_finite_at_the_plate) {
  const MirroredPiece piece{.charge = q, .x = h - 1e-3, .length = 4e-3, .radius = 1e-5};
  const double d = 1e-3, l = 4e-3;
  EXPECT_NEAR(
      own_image_force(piece, collector)
          / (constants::coulomb * q * q / (2 * d * std::sqrt(4 * d * d + l * l / 4))),
      1, 1e-14);
  double before = 0;
  for (const double x : {h - 1e-3, h - 1e-4, h - 1e-5, h - 1e-7, h, h + 1e-4}) {
    MirroredPiece p = piece;
    p.x = x;
    const double force = own_image_force(p, collector);
    if (x <= h - 1e-5)
      EXPECT_GT(force, before);
    else
      EXPECT_NEAR(force / before, 1, 1e-6);
    before = force;
    EXPECT_NEAR(own_image_force(p, plates) / force, 1, 1e-2);
  }
}

Chain some_chain() {
  Chain chain(40);
  for (std::size_t k = 0; k < chain.beads; ++k) {
    const auto s = static_cast<double>(k);
    chain.place(k, {0.997 * h * (s + 0.3) / 40, 0.03 * std::sin(0.9 * s),
                    0.04 * std::cos(0.7 * s)});
    chain.charge[k] = q * (1 + 0.5 * std::sin(3 * s));
    chain.volume[k] = 1e-15;
  }
  return chain;
}

/// By images of other charges, one by one: `order` on each side.
Vec3 exact_force(Chain& chain, std::size_t k, bool both_plates, int order) {
  const auto r = chain.columns().position();
  Vec3 field = Vec3::Zero();
  const auto add = [&](const Vec3& at, double charge) {
    const Vec3 d = r[k] - at;
    field += charge / std::pow(d.norm(), 3) * d;
  };
  for (std::size_t j = 0; j < chain.beads; ++j) {
    if (j == k) continue;
    const Vec3 place = r[j];
    if (!both_plates) {
      add({2 * h - place.x(), place.y(), place.z()}, -chain.charge[j]);
      continue;
    }
    for (int i = 1; i <= order; ++i)
      for (const double side : {1., -1.}) {
        add({place.x() + side * 2 * h * i, place.y(), place.z()}, chain.charge[j]);
        add({h + side * h * (2 * i - 1) - place.x(), place.y(), place.z()},
            -chain.charge[j]);
      }
  }
  return constants::coulomb * chain.charge[k] * field;
}

TEST(ImageForce, is_the_sum_over_the_images_of_all_others) {
  Chain chain = some_chain();
  double total = 0;
  for (const double charge : chain.charge) total += charge;
  const double unit = constants::coulomb * q * total / (h * h);
  for (const bool both : {false, true})
    for (const auto& [solver, tolerance] :
         {std::pair{"direct", 1e-13}, {"treecode", 1e-6}, {"fmm", 1e-6}}) {
      ImageForce term(both ? plates : collector,
                      make_coulomb_solver({.solver = solver, .tolerance = 1e-7}));
      const auto force = chain.force(term);
      double largest = 0;
      for (std::size_t k = 0; k < chain.beads; ++k)
        largest =
            std::max(largest, (force[k] - exact_force(chain, k, both, 3000)).norm() / unit);
      EXPECT_LE(largest, both ? 3e-4 : tolerance) << solver;
    }
}

// A bead close to the plate, whose own image is much stronger than all others.
TEST(ImageForce, is_exact_at_the_plate) {
  for (const double distance : {1e-3, 1e-5, 1e-9, 0.0}) {
    Chain chain = some_chain();
    chain.place(39, {h - distance, 0.01, 0});
    for (const char* solver : {"direct", "fmm"}) {
      ImageForce term(collector,
                      make_coulomb_solver({.solver = solver, .tolerance = 1e-9}));
      const Vec3 force = chain.force(term)[39], exact = exact_force(chain, 39, false, 1);
      EXPECT_LE((force - exact).norm(), 1e-6 * exact.norm()) << distance << solver;
    }
  }
}

// F = - dU/dr, and what charging bead 1 costs is dU/dq.
TEST(ImageForce, has_an_energy) {
  for (const bool both : {false, true}) {
    Chain chain = some_chain();
    ImageForce term(both ? plates : collector, make_coulomb_solver({}));
    const auto force = chain.force(term);
    constexpr double step = 1e-6;
    for (const std::size_t k : {0U, 1U, 17U, 38U})
      for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
        const Vec3 place = chain.columns().position()[k];
        chain.place(k, place + step * axis);
        const double after = term.energy(chain.stage());
        chain.place(k, place - step * axis);
        const double before = term.energy(chain.stage());
        chain.place(k, place);
        EXPECT_NEAR((before - after) / (2 * step), force[k].dot(axis),
                    1e-6 * force[k].norm())
            << both << k;
      }
    const double charge = chain.charge[1];
    chain.charge[1] = charge * 1.5;
    const double more = term.energy(chain.stage());
    chain.charge[1] = charge;
    EXPECT_NEAR(term.feeding_power(chain.stage(), {.charge = charge * 0.5})
                    / (more - term.energy(chain.stage())),
                1, 1e-8);
  }
}

// Between grounded plates the potential of a charge vanishes on both.
TEST(ImageForce, keeps_both_plates_at_potential_zero) {
  for (const double x : {0.0, h}) {
    Chain chain(2);
    chain.charge = {q, q};
    chain.place(0, {0.3 * h, 0, 0}), chain.place(1, {x, 0.4 * h, 0});
    ImageForce term(plates, make_coulomb_solver({}));
    const double r = (chain.columns().position()[1] - chain.columns().position()[0]).norm();
    const double direct = constants::coulomb * q * q / r;
    EXPECT_NEAR(term.energy(chain.stage()) / direct, -1, 2e-4);
  }
}

} // namespace
} // namespace ehdjet
