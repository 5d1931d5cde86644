#include "ehdjet/core/constants.hpp"
#include "ehdjet/forces/mat_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/budgeted.hpp"
#include "support/chain.hpp"
#include "support/continued.hpp"
#include "support/refined.hpp"

// Charges that stay on an insulating collector (model 5.2).
namespace ehdjet {
namespace {

using namespace test;

/// A whipping jet onto an insulating collector, many of whose beads have landed after 20 ms.
Scene jet(double refinement, double rtol = 1e-5) {
  Scene s = refined_case(refinement, 1e-3, rtol);
  s.config.collector->charge = CollectorCharge::kept_on_mat;
  return s;
}
void move_collector(Scene& scene, const Vec3& u) {
  scene.config.collector->velocity = {u.x(), u.y(), u.z()};
}

TEST(Mat, acts_as_the_sum_over_its_charges) {
  constexpr double tau = 0.02, t = 0.013;
  const Plate plate{.distance = 0.2, .velocity = {0, 2, -1}};
  std::shared_ptr<const Mat> mat;
  std::vector<std::pair<Vec3, double>> charges; // where and as they are at t
  for (int j = 0; j < 400; ++j) {
    const double added = j * 3e-5, q = 1e-11 * (1 + j % 7);
    const Vec3 place(0.2, 0.05 * std::sin(j), 0.05 * std::cos(1.7 * j));
    mat = with_charge(mat, place, q, added, tau);
    charges.emplace_back(place + t * plate.velocity, q * std::exp(-(t - added) / tau));
  }
  Chain chain(90);
  for (std::size_t k = 0; k < chain.beads; ++k) {
    const auto s = static_cast<double>(k);
    chain.place(k, {2.2e-3 * s, 0.04 * std::sin(0.3 * s), 0.03 * std::cos(0.4 * s)});
    chain.charge[k] = 2e-11 * (1 + 0.1 * std::sin(s));
  }
  chain.stage().mat = mat.get(), chain.stage().time = t;
  for (const auto& [solver, tolerance] :
       {std::pair{"direct", 1e-12}, {"treecode", 1e-5}, {"fmm", 1e-5}, {"auto", 1e-5}}) {
    MatForce term(plate, tau, make_coulomb_solver({.solver = solver, .tolerance = 1e-5}));
    const auto force = chain.force(term);
    double energy = 0, worst = 0, size = 0;
    for (std::size_t k = 0; k < chain.beads; ++k) {
      Vec3 exact = Vec3::Zero();
      for (const auto& charge : charges) {
        const Vec3 d = chain.columns().position()[k] - charge.first;
        const double v = constants::coulomb * chain.charge[k] * charge.second / d.norm();
        energy += v, exact += v / d.squaredNorm() * d;
      }
      worst = std::max(worst, (force[k] - exact).norm());
      size = std::max(size, exact.norm());
    }
    EXPECT_LE(worst / size, tolerance) << solver;
    EXPECT_NEAR(term.energy(chain.stage()) / energy, 1, 1e-12);
  }
}

// Every bead that has left is there.
TEST(Mat, is_the_deposit) {
  for (const std::string method : {"dormand-prince", "two-rate"}) {
    Scene scene = jet(0.4 * cm);
    scene.config.integrator.method = method;
    move_collector(scene, {0, 3, 1});
    auto simulation = build_simulation(scene);
    std::vector<DepositedBead> deposit;
    simulation->add(std::make_unique<Deposit>(deposit));
    simulation->run_until(16e-3);
    ASSERT_TRUE(simulation->jet().mat);
    const Mat& mat = *simulation->jet().mat;
    ASSERT_GT(mat.size(), 20U);
    ASSERT_EQ(mat.size(), deposit.size());
    std::size_t i = 0;
    mat.for_each_part([&](const MatCharges& part) {
      for (std::size_t j = 0; j < part.size(); ++j, ++i) {
        EXPECT_LE((part.place()[j] - deposit[i].bead.position).norm(), 1e-15);
        EXPECT_EQ(part.charge[j], deposit[i].bead.charge);
      }
      EXPECT_EQ(part.time, deposit[i - 1].removal_time);
    });
  }
}

using SharedMat = std::shared_ptr<const Mat>;
SharedMat with_charges(SharedMat mat, std::size_t first, std::size_t last) {
  for (std::size_t j = first; j < last; ++j) {
    const auto s = static_cast<double>(j);
    mat = with_charge(mat, {0.2, std::sin(s), std::cos(1.7 * s)}, 1e-11, 1e-3 * s, 0.01);
  }
  return mat;
}
Checkpoint saved(SharedMat mat) {
  Checkpoint lists;
  archive(Archive::into(lists), mat);
  return lists;
}

// Solvers keep their tree as long as it is the same object.
TEST(Mat, shares_its_settled_charges_with_those_that_grow_from_it) {
  const SharedMat mat = with_charges(nullptr, 0, 3 * Mat::block),
                  later = with_charges(mat, mat->size(), mat->size() + Mat::block - 1),
                  settled = with_charges(later, later->size(), later->size() + 1);
  EXPECT_EQ(mat->settled, later->settled);
  EXPECT_EQ(later->recent.size(), Mat::block - 1);
  EXPECT_NE(settled->settled, later->settled);
  EXPECT_EQ(settled->settled->size(), 4 * Mat::block);
  EXPECT_EQ(settled->recent.size(), 0U);
}

TEST(Mat, from_a_checkpoint_grows_with_the_same_bits) {
  for (const std::size_t n : {0U, 1U, 63U, 64U, 200U}) {
    const SharedMat mat = with_charges(nullptr, 0, n);
    SharedMat read;
    const Checkpoint lists = saved(mat);
    archive(Archive::from(lists), read);
    EXPECT_EQ(saved(with_charges(read, n, n + 100)), saved(with_charges(mat, n, n + 100)));
  }
}

// As before charges settled: all in one part.
TEST(Mat, of_an_older_checkpoint_is_read) {
  const SharedMat mat = with_charges(nullptr, 0, 100);
  Checkpoint old;
  for (const char* list : {"x", "y", "z", "charge"}) {
    const Checkpoint lists = saved(mat);
    old[list] = lists.at(std::string("settled.") + list);
    const auto& recent = lists.at(list);
    old[list].insert(old[list].end(), recent.begin(), recent.end());
  }
  old["time"] = {0.1};
  SharedMat read;
  archive(Archive::from(old), read);
  EXPECT_EQ(read->size(), 100U);
  EXPECT_EQ(with_charges(read, 100, 101)->settled->size(), 101U);
}

// The tree of other charges must not be taken for theirs, wherever they are in memory.
TEST(Mat, that_has_been_taken_back_leaves_nothing_behind) {
  Chain chain(90);
  for (std::size_t k = 0; k < chain.beads; ++k) {
    const auto s = static_cast<double>(k);
    chain.place(k, {2.2e-3 * s, 0.04 * std::sin(0.3 * s), 0.03 * std::cos(0.4 * s)});
    chain.charge[k] = 2e-11;
  }
  const auto solver = [] {
    return make_coulomb_solver({.solver = "fmm", .tolerance = 1e-3});
  };
  const Plate plate{.distance = 0.2, .velocity = Vec3::Zero()};
  MatForce term(plate, {}, solver());
  const SharedMat few = with_charges(nullptr, 0, 32 * Mat::block - 1);
  for (int i = 0; i < 20; ++i) {
    SharedMat mat = with_charge(few, {0.2, 0.1 * i, 0}, 1e-8 * i, 1, {});
    chain.stage().mat = mat.get();
    MatForce fresh(plate, {}, solver());
    EXPECT_EQ(chain.force(term), chain.force(fresh));
    chain.stage().mat = few.get();
    EXPECT_EQ(chain.force(term), chain.force(fresh));
    if (i % 2 == 0) continue;
    mat = with_charges(nullptr, 0, 10); // without settled charges
    chain.stage().mat = mat.get();
    EXPECT_EQ(chain.force(term), chain.force(fresh));
  }
}

TEST(Mat, is_absent_if_charges_do_not_stay) {
  for (const CollectorCharge charge : {CollectorCharge::grounded, CollectorCharge::kept}) {
    Scene scene = jet(0.8 * cm);
    scene.config.collector->charge = charge;
    const auto simulation = run(scene, 14e-3);
    EXPECT_GT(simulation->statistics().landings, 5U);
    EXPECT_FALSE(simulation->jet().mat);
  }
}

TEST(Mat, has_a_budget_that_closes) {
  Scene still = jet(0.8 * cm, 1e-7), moving = still, decaying = still;
  move_collector(moving, {0, 20, -5});
  decaying.config.collector->decay_time = 2e-3;
  for (const Scene& scene : {still, moving, decaying}) {
    const FinishedRun run(scene, 14e-3, 3e-3);
    EXPECT_GT(run.simulation->jet().mat->size(), 5U);
    EXPECT_LE(std::abs(run.last().at("energy_residual_relative")), 2e-7);
    EXPECT_LE(std::abs(run.last().at("momentum_residual_relative")), 2e-7);
    EXPECT_GT(run.last().at("mat_energy"), 1e-4 * run.last().at("coulomb_energy"));
    const bool exchanges =
        scene.config.collector->velocity || scene.config.collector->decay_time;
    EXPECT_EQ(run.last().at("mat_exchange") != 0, exchanges);
  }
}

// Charges that decay at once are as good as none.
TEST(Mat, that_decays_at_once_is_hardly_there) {
  Scene scene = jet(0.8 * cm), kept = scene;
  scene.config.collector->decay_time = 1e-7;
  kept.config.collector->charge = CollectorCharge::kept;
  const auto a = run(scene, 14e-3), b = run(kept, 14e-3), c = run(jet(0.8 * cm), 14e-3);
  EXPECT_LE(largest_distance(a->jet(), b->jet()), 1e-4);
  EXPECT_GT(largest_distance(a->jet(), c->jet()), 1e-3);
}

TEST(Mat, is_the_same_with_two_rates_and_fast_solvers) {
  Scene scene = jet(0.4 * cm, 1e-6);
  scene.config.collector->decay_time = 10e-3;
  move_collector(scene, {0, 3, 1});
  scene.config.integrator.method = "dormand-prince";
  const auto one = run(scene, 13e-3);
  Scene with_trees = scene;
  with_trees.config.coulomb->solver = "fmm";
  with_trees.config.coulomb->tolerance = 1e-7;
  EXPECT_LE(largest_distance(one->jet(), run(with_trees, 13e-3)->jet()), 2e-5);
  scene.config.integrator.method = "two-rate";
  const auto two = run(scene, 13e-3);
  EXPECT_GT(two->statistics().two_rates->steps, 10U);
  EXPECT_NEAR(one->ledger().impact_speed / two->ledger().impact_speed, 1, 1e-3);
  EXPECT_NEAR(static_cast<double>(one->jet().mat->size()),
              static_cast<double>(two->jet().mat->size()), 1);
}

TEST(Mat, goes_on_from_a_checkpoint_with_the_same_bits) {
  for (const char* method : {"dormand-prince", "two-rate"}) {
    Scene scene = jet(0.8 * cm);
    scene.config.collector->decay_time = 10e-3;
    scene.config.integrator.method = method;
    move_collector(scene, {0, 3, 1});
    expect_same_bits_after_checkpoints(scene, 6e-3, 14e-3);
  }
}

} // namespace
} // namespace ehdjet
