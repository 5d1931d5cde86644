#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <memory>

#include "coulomb/all_solvers.hpp"
#include "coulomb/reference.hpp"

namespace ehdjet::test {
namespace {

PointCharges charges(const Chain& c) {
  return {c.r(), c.q, {}};
}
PointCharges part(const Chain& c, std::size_t begin, std::size_t end) {
  const auto of = [&](const std::vector<double>& v) {
    return std::span<const double>(v).subspan(begin, end - begin);
  };
  return {{of(c.x), of(c.y), of(c.z)}, of(c.q), {}};
}
Force force_from(const PointCharges& sources, const PointCharges& targets,
                 CoulombSolver& solver) {
  Force force(targets.size());
  solver.add_force_from(sources, targets, force.view());
  return force;
}
/// Largest |f - F| / sum_j |f_ij| over the targets.
double worst_error(const PointCharges& sources, const PointCharges& targets,
                   const Force& force) {
  Chain c; // one target at a time in front of the sources
  c.add(Vec3::Zero(), 0);
  for (std::size_t j = 0; j < sources.size(); ++j) c.add(sources.r[j], sources.q[j]);
  double worst = 0;
  for (std::size_t k = 0; k < std::min<std::size_t>(targets.size(), 100); ++k) {
    const std::size_t i = k * targets.size() / std::min<std::size_t>(targets.size(), 100);
    c.set(0, targets.r[i]), c.q[0] = targets.q[i];
    const double error = ReferenceForce(c, 0).error_of(force[i]);
    if (error > worst || std::isnan(error)) worst = error;
  }
  return worst;
}

class OneWay : public SolverTest {};

TEST_P(OneWay, parts_of_a_chain_act_on_others) {
  const Chain c = random_chain(1123, 2, 1);
  const std::pair<std::size_t, std::size_t> ranges[]{
      {0, 1}, {0, 7}, {3, 350}, {350, 1123}, {900, 1123}};
  for (const auto& [a, b] : ranges)
    for (const auto& [from, to] : ranges) {
      const PointCharges sources = part(c, a, b), targets = part(c, from, to);
      const Force force = force_from(sources, targets, *solver);
      EXPECT_LE(worst_error(sources, targets, force), tolerance())
          << a << ' ' << b << " on " << from << ' ' << to;
      const std::size_t begin = std::max(a, from), end = std::min(b, to);
      EXPECT_EQ(solver->coincident_pairs(), end > begin ? end - begin : 0);
    }
}

TEST_P(OneWay, sources_that_are_known_again_act_with_the_same_bits) {
  Chain cloud = random_chain(3000, 2, 1), other = random_chain(3000, 2, 2),
        jet = helix(700, 1, 0.3, 1e-2);
  const auto same_as_fresh = [&](const PointCharges& sources, const PointCharges& targets,
                                 const std::string& what) {
    const auto fresh = GetParam().make();
    EXPECT_EQ(force_from(sources, targets, *solver), force_from(sources, targets, *fresh))
        << what;
  };
  PointCharges known = charges(cloud);
  const auto identity = std::make_shared<const int>(1);
  known.identity = identity;
  same_as_fresh(known, charges(jet), "first");
  same_as_fresh(known, charges(jet), "again");
  same_as_fresh(known, part(jet, 100, 640), "on fewer targets");
  const Chain far = helix(700, 1000, 0.3, 1e-2);
  same_as_fresh(known, charges(far), "on targets so far that the unit is another one");
  const std::vector<std::uint8_t> moves(jet.size(), 1);
  PointCharges moving = charges(jet);
  moving.moves = moves;
  same_as_fresh(known, moving, "on targets of which some may rest");
  same_as_fresh(charges(jet), charges(cloud), "in reverse");
  same_as_fresh(known, charges(jet), "after that");
  Force force(jet.size());
  solver->add_force(charges(jet), force.view());
  same_as_fresh(known, charges(jet), "after forces of the targets on each other");
  PointCharges others = charges(other);
  others.identity = std::make_shared<const int>(2);
  same_as_fresh(others, charges(jet), "others");
}

// Else other charges could get the address of those that are gone, and their tree.
TEST(OneWayIdentity, lives_as_long_as_what_is_known_of_the_sources) {
  const Chain cloud = random_chain(3000, 2, 1), jet = helix(700, 1, 0.3, 1e-2);
  const auto solver = make_coulomb_solver({.solver = "fmm", .tolerance = 1e-3});
  PointCharges known = charges(cloud);
  known.identity = std::make_shared<const int>(1);
  const std::weak_ptr<const void> identity = known.identity;
  (void)force_from(known, charges(jet), *solver);
  known.identity.reset();
  EXPECT_FALSE(identity.expired());
  (void)force_from(charges(jet), charges(cloud), *solver);
  EXPECT_TRUE(identity.expired());
}

TEST_P(OneWay, nobody_acts_on_nobody) {
  const Chain c = random_chain(40, 1, 1);
  EXPECT_EQ(force_from({}, charges(c), *solver), Force(40));
  EXPECT_EQ(force_from(charges(c), {}, *solver), Force(0));
  EXPECT_EQ(solver->coincident_pairs(), 0U);
}

TEST_P(OneWay, the_force_is_added_and_other_calls_leave_no_trace) {
  const Chain c = random_chain(900, 1, 1), other = random_chain(300, 1, 1, 2);
  const Force mutual = force_on(c, *solver),
              once = force_from(charges(c), charges(other), *solver);
  EXPECT_EQ(force_on(c, *solver), mutual);
  Force twice = once;
  solver->add_force_from(charges(c), charges(other), twice.view());
  for (std::size_t i = 0; i < other.size(); ++i) EXPECT_EQ(twice[i], 2 * once[i]) << i;
}

// Charges in front of a grounded plane and their images: no force along the plane is left on it.
TEST_P(OneWay, mirrored_images_make_a_plane_an_equipotential) {
  const Chain c = random_chain(700, 1, 1);
  Chain images = c, plane(200);
  for (double& x : images.x) x = 400 - x;
  for (double& q : images.q) q = -q;
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane.set(i, {200, 0.1 * static_cast<double>(i), 7});
  Force field = force_from(charges(c), charges(plane), *solver);
  solver->add_force_from(charges(images), charges(plane), field.view());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const double allowed =
        4 * tolerance() * static_cast<double>(constants::coulomb) * 700 / (100. * 100.);
    EXPECT_LE(std::abs(field.y[i]), allowed) << i;
    EXPECT_LE(std::abs(field.z[i]), allowed) << i;
  }
}

TEST_P(OneWay, sets_of_different_length_and_place_are_a_contract_violation) {
  const Chain c = random_chain(5, 1, 1);
  Force force(4);
  EXPECT_THROW(solver->add_force_from(charges(c), charges(c), force.view()),
               ContractViolation);
}

EHDJET_FOR_ALL_SOLVERS(OneWay);

// In the norm of the net force, against the direct sum.
TEST(OneWayNorm, keeps_the_tolerance_on_the_targets) {
  Chain jet = helix(3000, 1, 0.02, 1e-3), mat;
  for (std::size_t i = 0; i < 5000; ++i) {
    const auto k = static_cast<double>(i);
    mat.add({3, std::fmod(0.8191725134 * k, 1.) * 4 - 2,
             std::fmod(0.671043607 * k, 1.) * 4 - 2},
            1);
  }
  for (const auto& [sources, targets] :
       {std::pair(&jet, &mat), std::pair(&mat, &jet), std::pair(&jet, &jet)}) {
    const Force exact =
        force_from(charges(*sources), charges(*targets), *make_direct_sum());
    for (const std::string name : {"treecode", "fmm", "auto"})
      for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9})
        for (const auto norm : {ToleranceNorm::global, ToleranceNorm::moving}) {
          const auto solver =
              make_coulomb_solver({.solver = name, .tolerance = tolerance, .norm = norm});
          const Force force = force_from(charges(*sources), charges(*targets), *solver);
          double error = 0, size = 0;
          for (std::size_t i = 0; i < force.x.size(); ++i)
            error += (force[i] - exact[i]).squaredNorm(), size += exact[i].squaredNorm();
          EXPECT_LE(std::sqrt(error / size), tolerance) << name << ' ' << tolerance;
        }
  }
}

// A cluster of a hundred thousand sources acts on few targets, whose forces say little of its errors.
TEST(OneWayNorm, keeps_the_tolerance_on_few_targets_of_many_sources) {
  const Chain jet = helix(1000, 1, 0.02, 1e-3);
  Chain cloud;
  for (std::size_t i = 0; i < 100'000; ++i) {
    const auto k = static_cast<double>(i);
    cloud.add({3 + 1e-3 * std::fmod(0.5497004779 * k, 1.),
               std::fmod(0.8191725134 * k, 1.) * 4 - 2,
               std::fmod(0.671043607 * k, 1.) * 4 - 2},
              1);
  }
  const Force exact = force_from(charges(cloud), charges(jet), *make_direct_sum());
  for (const std::string name : {"treecode", "fmm"})
    for (const double tolerance : {1e-3, 1e-5, 1e-7})
      for (const auto norm : {ToleranceNorm::global, ToleranceNorm::moving}) {
        const auto solver =
            make_coulomb_solver({.solver = name, .tolerance = tolerance, .norm = norm});
        const Force force = force_from(charges(cloud), charges(jet), *solver);
        double error = 0, size = 0;
        for (std::size_t i = 0; i < force.x.size(); ++i)
          error += (force[i] - exact[i]).squaredNorm(), size += exact[i].squaredNorm();
        EXPECT_LE(std::sqrt(error / size), tolerance) << name << ' ' << tolerance;
      }
}

} // namespace
} // namespace ehdjet::test
