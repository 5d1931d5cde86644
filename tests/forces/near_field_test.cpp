#include "ehdjet/core/constants.hpp"
#include "ehdjet/forces/near_field.hpp"
#include "ehdjet/forces/softened_pairs.hpp"
#include "ehdjet/forces/sub_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "support/chain.hpp"

namespace ehdjet {
namespace {

using namespace test;
using Long = long double;

// c = d + e and e from an independent computation.
TEST(SubGrid, of_softened_pairs_has_the_published_values) {
  struct Row {
    double eta, c, e;
  };
  for (const auto& [eta, c, e] : {Row{0.01, 3.72128199074179, -0.99987980986171},
                                  Row{0.1, 1.43635521961894, -0.988133101152178},
                                  Row{0.25, 0.607827335071342, -0.930516855128},
                                  Row{0.5, 0.165248103806019, -0.773833755184577},
                                  Row{1, 0.0105993066756293, -0.487565078449797},
                                  Row{2, 2.94486162404e-5, -0.24996810897}}) {
    const SubGrid s = sub_grid_of_softened(eta);
    EXPECT_NEAR(s.d + s.e, c, 1e-13) << eta;
    EXPECT_NEAR(s.e, e, 5e-12) << eta;
  }
}

// The definition, summed up to N links with the first correction of the midpoint rule.
Long softened_by_definition(Long eta) {
  constexpr int links = 20'000;
  Long sum = 0;
  for (int p = links; p >= 1; --p) sum += 1 / std::sqrt(Long(p) * p + eta * eta);
  const Long x = links + Long(0.5), root = std::sqrt(x * x + eta * eta);
  return std::asinh(x / eta) - sum + x / (24 * root * root * root);
}

TEST(SubGrid, is_its_definition_on_both_sides_of_the_change_of_series) {
  for (const double eta : {0.02, 0.3, 0.499999, 0.5, 0.500001, 0.7, 1.5})
    EXPECT_NEAR(sub_grid_of_softened(eta).d, double(softened_by_definition(eta)), 2e-13)
        << eta;
}

TEST(SubGrid, has_the_derivatives_that_it_says) {
  for (const auto& of : {sub_grid_of_points, sub_grid_of_softened})
    for (const double eta : {0.003, 0.2, 0.49, 0.6, 2.0}) {
      const double h = 1e-4;
      const SubGrid s = of(eta), up = of(eta * std::exp(h)), down = of(eta * std::exp(-h));
      EXPECT_NEAR(s.e, (up.d - down.d) / (2 * h), 1e-7) << eta;
      EXPECT_NEAR(s.f, (up.e - down.e) / (2 * h), 1e-7) << eta;
    }
}

// A step that has blown up must fail, not go on for ever.
TEST(SubGrid, of_no_number_is_no_number) {
  const double none = std::nan("");
  EXPECT_TRUE(std::isnan(sub_grid_of_softened(none).d));
  EXPECT_TRUE(std::isnan(sub_grid_of_points(none).d));
}

TEST(SubGrid, of_softened_pairs_goes_over_into_that_of_points) {
  const double eta = 1e-4;
  EXPECT_NEAR(sub_grid_of_softened(eta).d, sub_grid_of_points(eta).d, 1e-8);
  EXPECT_NEAR(sub_grid_of_softened(eta).e, -1, 1e-7);
}

/// A random chain whose links are `slenderness` radii long.
Chain random_chain(double slenderness, unsigned seed, std::size_t beads = 7) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> factor(0.6, 1.6);
  const double length = 2e-4, radius = length / slenderness;
  Chain chain(beads);
  Vec3 at(1e-3, -2e-3, 3e-3);
  for (std::size_t k = 0; k < beads; ++k) {
    chain.place(k, at);
    const Vec3 step =
        Vec3(1, 0, 0) + 0.5 * Vec3(normal(random), normal(random), normal(random));
    at += factor(random) * length * step.normalized();
    chain.volume[k] = factor(random) * std::numbers::pi * radius * radius * length;
    chain.charge[k] = factor(random) * 2e-12;
  }
  return chain;
}

/// Energy of the chain as model 3.1 defines it, in long double, of these places (3 beads).
Long energy(const Chain& chain, const std::vector<Long>& r, bool softened) {
  const std::size_t n = chain.beads;
  const auto distance = [&](std::size_t i, std::size_t j) {
    Long square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Long d = r[c * n + i] - r[c * n + j];
      square += d * d;
    }
    return std::sqrt(square);
  };
  std::vector<Long> square(n);
  Long sum = 0;
  for (std::size_t k = 1; k < n; ++k) {
    const Long l = distance(k, k - 1), pi = std::numbers::pi_v<Long>;
    square[k] = chain.volume[k] / (pi * l);
    const Long eta = std::sqrt(square[k]) / l;
    const Long d = softened ? softened_by_definition(eta)
                            : std::log(2 / eta) - std::numbers::egamma_v<Long>;
    sum += Long(chain.charge[k]) * chain.charge[k] / l * d;
  }
  square[0] = square[1];
  if (softened)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Long d = distance(i, j), eps = std::sqrt((square[i] + square[j]) / 2);
        const auto g = [](Long x) { return 1 / std::sqrt(1 + x * x) - 1 / x; };
        const auto slope = [](Long x) {
          return 1 / (x * x) - x / ((1 + x * x) * std::sqrt(1 + x * x));
        };
        const Long x = d / eps, end = 40;
        if (x < end)
          sum += Long(chain.charge[i]) * chain.charge[j]
                 * (g(x) - g(end) - (x - end) * slope(end)) / eps;
      }
  return constants::coulomb * sum;
}

/// -dU/dr of every bead by central differences of fourth order.
std::vector<Vec3> gradient_force(Chain& chain, bool softened) {
  const std::size_t n = chain.beads;
  std::vector<Long> r;
  for (const auto axis : {chain.columns().position().x, chain.columns().position().y,
                          chain.columns().position().z})
    r.insert(r.end(), axis.begin(), axis.end());
  std::vector<Vec3> force(n);
  const Long h = 2e-8L;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const Long before = r[c * n + k];
      const auto at = [&](int steps) {
        r[c * n + k] = before + steps * h;
        const Long u = energy(chain, r, softened);
        r[c * n + k] = before;
        return u;
      };
      force[k][static_cast<int>(c)] =
          -double((8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h));
    }
  return force;
}

TEST(NearField, of_a_free_surface_is_the_gradient_of_its_energy) {
  for (const double slenderness : {1.0, 4.0, 10.0, 100.0})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      Chain chain = random_chain(slenderness, seed);
      NearField term({});
      const auto force = chain.force(term), exact = gradient_force(chain, false);
      double error = 0;
      for (std::size_t k = 0; k < chain.beads; ++k)
        error = std::max(error, (force[k] - exact[k]).norm());
      EXPECT_LE(error, 1e-11 * sum_of_norms(exact)) << slenderness;
      EXPECT_LE(sum(force).norm(), 1e-14 * sum_of_norms(force));
    }
}

TEST(NearField, with_softened_pairs_is_the_gradient_of_its_energy) {
  for (const double slenderness : {1.0, 4.0, 10.0, 30.0}) {
    Chain chain = random_chain(slenderness, 5);
    NearField term({.softened = true});
    SoftenedPairs pairs({});
    auto force = chain.force(term);
    const auto more = chain.force(pairs), exact = gradient_force(chain, true);
    double error = 0;
    for (std::size_t k = 0; k < chain.beads; ++k)
      error = std::max(error, (force[k] + more[k] - exact[k]).norm());
    EXPECT_LE(error, 1e-9 * sum_of_norms(exact)) << slenderness;
    EXPECT_GT(sum_of_norms(more), 1e-4 * sum_of_norms(force));
  }
}

TEST(NearField, pushes_the_ends_of_a_link_apart_by_the_formula) {
  const double l = 3e-4, a = 1e-5, q = 2e-12;
  Chain chain(2);
  chain.place(1, {l, 0, 0});
  chain.volume[1] = std::numbers::pi * a * a * l, chain.charge[1] = q;
  for (const auto& [kind, b] : {std::pair{NearFieldKind::free_surface, 1.3840684843415876},
                                {NearFieldKind::fixed, 0.8840684843415876}}) {
    NearField term({.kind = kind});
    const double push = constants::coulomb * q * q / (l * l) * (std::log(l / a) - b);
    EXPECT_NEAR(chain.force(term)[1].x() / push, 1, 1e-14);
    std::vector<double> tension(2);
    term.add_tension(chain.stage(), tension);
    EXPECT_NEAR(tension[1] / push, -1, 1e-14);
  }
}

// The charge of a landed bead's link is that of the link, whatever the bead does to others.
TEST(NearField, goes_by_the_charge_of_the_link) {
  Chain chain = random_chain(10, 3);
  NearField term({});
  const auto before = chain.force(term);
  Stage stage = chain.stage();
  std::vector<double> grounded(chain.beads, 0.0), f(3 * chain.beads);
  stage.charge = grounded;
  const std::span<double> all(f);
  const std::size_t n = chain.beads;
  term.add_force(stage, {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)});
  for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(f[k], before[k].x());
}

/// A chain with an embryo, the link behind it d long.
Chain with_embryo(double d, double step) {
  Chain chain = random_chain(8, 9);
  const Vec3 start = chain.columns().position()[0];
  const Vec3 along = Vec3(1, 2, 2) / 3;
  chain.place(1, start + step * along);
  for (std::size_t k = 2; k < chain.beads; ++k)
    chain.place(k, start + (d + 1e-4 * static_cast<double>(k - 2)) * along);
  return chain;
}

// At its creation the link behind it pushes like the whole, at its release like the rest.
TEST(NearField, changes_continuously_when_an_embryo_comes_and_goes) {
  const double step = 2e-4;
  const Embryo embryo{.link_length = step};
  NearField term({.embryo = embryo});
  for (const auto& [d, acts_as] : {std::pair{1.5 * step, 1.5 * step}, {2 * step, step}}) {
    Chain chain = with_embryo(d, step);
    chain.first = 2;
    std::vector<double> tension(chain.beads), alone(2);
    term.add_tension(chain.stage(), tension);
    Chain link(2);
    link.place(1, {acts_as, 0, 0});
    link.volume[1] = chain.volume[2], link.charge[1] = chain.charge[2];
    NearField({}).add_tension(link.stage(), alone);
    EXPECT_NEAR(tension[2] / alone[1], 1, 1e-12);
    EXPECT_NEAR(chain.force(term)[0].norm() / std::abs(tension[2]), 1, 1e-12);
  }
}

/// x of the force on these beads, the only ones asked for.
std::vector<double> x_forces(ForceTerm& term, Chain& chain, BeadRange targets) {
  Stage& stage = chain.stage();
  stage.targets = targets;
  stage.invalidate();
  const std::size_t n = chain.beads;
  std::vector<double> f(3 * n);
  const std::span<double> all(f);
  term.add_force(stage, {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)});
  return f;
}

TEST(SoftenedPairs, are_absent_where_links_are_long) {
  Chain chain = random_chain(100, 2);
  SoftenedPairs pairs({});
  for (const Vec3& f : chain.force(pairs)) EXPECT_EQ(f.norm(), 0);
}

// Behind an embryo, too, where the radius of bead 0 is that of link 2.
TEST(SoftenedPairs, of_a_part_behind_an_embryo_are_those_of_the_whole) {
  const Embryo embryo{.link_length = 2e-4};
  Chain chain = with_embryo(3.5e-4, 2e-4);
  chain.first = 2;
  for (double& volume : chain.volume) volume *= 20;
  SoftenedPairs pairs({.embryo = embryo});
  const auto whole = chain.force(pairs);
  const auto f = x_forces(pairs, chain, {2, 5});
  for (std::size_t k = 2; k < 5; ++k)
    EXPECT_NEAR(f[k], whole[k].x(), 1e-12 * whole[k].norm()) << k;
}

// What a row of beads feels is what each pair at its ends gives, whichever part is asked for.
TEST(SoftenedPairs, of_a_part_of_a_chain_are_those_of_the_whole) {
  Chain chain = random_chain(3, 8, 12);
  SoftenedPairs pairs({});
  const auto whole = chain.force(pairs);
  const auto f = x_forces(pairs, chain, {4, 8});
  for (std::size_t k = 4; k < 8; ++k)
    EXPECT_NEAR(f[k], whole[k].x(), 1e-12 * whole[k].norm()) << k;
}

} // namespace
} // namespace ehdjet
