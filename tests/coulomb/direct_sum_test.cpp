#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include "coulomb/all_solvers.hpp"

namespace ehdjet::test {
namespace {

TEST(DirectSum, all_kernels_agree) {
  const Chain chain = random_chain(347, 0, 0);
  const auto portable = make_direct_sum(SimdLevel::portable);
  const Force expected = force_on(chain, *portable);
  for (const SolverCase& other : all_solvers()) {
    const auto solver = other.make();
    if (!solver || solver->accuracy().tolerance > 0) continue;
    const Force force = force_on(chain, *solver);
    double scale = 0; // the largest net force: unit charges a step of 1 apart hardly cancel
    for (std::size_t i = 0; i < chain.size(); ++i)
      scale = std::max(scale, expected[i].norm());
    for (std::size_t i = 0; i < chain.size(); ++i)
      EXPECT_LE((force[i] - expected[i]).norm(), 1e-14 * scale) << other.name << ' ' << i;
  }
}

TEST(DirectSum, every_level_has_a_name_and_the_best_one_runs) {
  EXPECT_EQ(name_of(SimdLevel::portable), "portable");
  EXPECT_EQ(name_of(SimdLevel::avx2), "avx2");
  EXPECT_EQ(name_of(SimdLevel::avx512), "avx512");
  EXPECT_NO_THROW(force_on(straight_chain(40), *make_direct_sum(best_simd_level())));
  if (best_simd_level() < SimdLevel::avx512) {
    EXPECT_THROW(make_direct_sum(SimdLevel::avx512), ContractViolation);
  }
}

TEST(DirectSum, promises_nothing_but_round_off) {
  const auto solver = make_direct_sum();
  EXPECT_EQ(solver->name(), "direct");
  EXPECT_EQ(solver->accuracy().tolerance, 0);
}

TEST(MakeSolver, makes_every_solver_it_lists) {
  EXPECT_FALSE(coulomb_solvers().empty());
  for (const SolverDescription& listed : coulomb_solvers()) {
    EXPECT_EQ(make_coulomb_solver({.solver = std::string(listed.name)})->name(),
              listed.name);
    EXPECT_FALSE(listed.description.empty());
  }
}

TEST(MakeSolver, an_unknown_name_is_answered_with_the_known_ones) {
  try {
    make_coulomb_solver({.solver = "dirct"});
    FAIL() << "no exception";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'dirct'"), std::string::npos) << message;
    EXPECT_NE(message.find("direct"), std::string::npos) << message;
  }
}

} // namespace
} // namespace ehdjet::test
