#include "ehdjet/core/error.hpp"

#include <omp.h>

#include "coulomb/all_solvers.hpp"
#include "coulomb/reference.hpp"
#include "support/allocations.hpp"

namespace ehdjet::test {
namespace {

/// Runs with so many threads, then restores what was.
class WithThreads {
public:
  explicit WithThreads(int threads)
      : before_(omp_get_max_threads()) {
    omp_set_num_threads(threads);
  }
  ~WithThreads() { omp_set_num_threads(before_); }
  WithThreads(const WithThreads&) = delete;
  WithThreads& operator=(const WithThreads&) = delete;

private:
  int before_;
};

class SolverHabits : public SolverTest {};

TEST_P(SolverHabits, the_same_number_of_threads_gives_the_same_bits) {
  const Chain chain = random_chain(1123, 3, 1);
  for (const int threads : {1, 2, 3}) {
    const WithThreads team(threads);
    const Force first = force_on(chain, *solver);
    EXPECT_LE(worst_error(chain, first, 50), tolerance()) << threads;
    for (int repeat = 0; repeat < 3; ++repeat)
      EXPECT_EQ(force_on(chain, *solver), first) << threads;
    EXPECT_EQ(force_on(chain, *GetParam().make()), first) << threads;
  }
}

TEST_P(SolverHabits, threads_find_every_coincident_pair) {
  const WithThreads team(3);
  Chain chain = random_chain(700, 1, 1);
  for (const std::size_t i : {0U, 300U, 301U, 699U}) chain.set(i, chain.r()[100]);
  EXPECT_LE(worst_error(chain, force_on(chain, *solver)), tolerance());
  EXPECT_EQ(solver->coincident_pairs(), 10U);
}

TEST_P(SolverHabits, a_number_of_beads_seen_before_allocates_nothing) {
  const WithThreads team(2);
  for (const std::size_t n : {150U, 600U}) {
    Chain chain = random_chain(n, 1, 1);
    chain.set(4, chain.r()[3]);
    Force force(n);
    solver->add_force({chain.r(), chain.q}, force.view());
    const std::size_t before = allocations();
    for (double& v : chain.x) v *= 1.5;
    solver->add_force({chain.r(), chain.q}, force.view());
    EXPECT_EQ(allocations(), before) << n;
  }
}

TEST_P(SolverHabits, columns_of_different_length_are_a_contract_violation) {
  const Chain chain(5);
  Force force(5);
  const auto add = [&](ConstVec3View r, std::span<const double> q, Vec3View f) {
    solver->add_force({r, q}, f);
  };
  const std::span<const double> shorter(chain.x.data(), 4);
  const Vec3View f = force.view();
  EXPECT_THROW(add({chain.x, chain.y, shorter}, chain.q, f), ContractViolation);
  EXPECT_THROW(add({shorter, chain.y, chain.z}, chain.q, f), ContractViolation);
  EXPECT_THROW(add(chain.r(), shorter, f), ContractViolation);
  EXPECT_THROW(add(chain.r(), chain.q, {f.x, f.y.first(4), f.z}), ContractViolation);
}

EHDJET_FOR_ALL_SOLVERS(SolverHabits);

} // namespace
} // namespace ehdjet::test
