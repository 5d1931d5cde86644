#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>

#include "coulomb/chains.hpp"

namespace ehdjet::test {

/// Something that every law below holds for. A new solver or kernel joins by one line in
/// all_solvers.cpp.
struct SolverCase {
  const char* name;
  std::unique_ptr<CoulombSolver> (*make)(); ///< null if this processor cannot run it
};
inline std::ostream& operator<<(std::ostream& os, const SolverCase& c) {
  return os << c.name;
}

const std::vector<SolverCase>& all_solvers();

class SolverTest : public testing::TestWithParam<SolverCase> {
protected:
  std::unique_ptr<CoulombSolver> solver = GetParam().make();

  void SetUp() override {
    if (!solver) GTEST_SKIP() << "not on this processor";
  }
  /// Of sum_j |f_ij|: rounding of a hundred-thousand-term sum, or what the solver promises.
  [[nodiscard]] double tolerance() const {
    return std::max(1e-13, solver ? solver->accuracy().tolerance : 0);
  }
};

#define EHDJET_FOR_ALL_SOLVERS(suite)                                                      \
  INSTANTIATE_TEST_SUITE_P(                                                                \
      all, suite, testing::ValuesIn(all_solvers()),                                        \
      [](const auto& tested) { return std::string(tested.param.name); })

} // namespace ehdjet::test
