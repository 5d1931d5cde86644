#include <gtest/gtest.h>

#include "support/bookkeeping.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

TEST(Bookkeeping, balances_to_round_off_over_the_whole_run_of_the_paper) {
  expect_balance_throughout(case_one("dormand-prince", 1e-4), 0.2, 2300);
}

} // namespace
} // namespace ehdjet
