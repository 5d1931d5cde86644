#include "ehdjet/core/parallel.hpp"
#include "ehdjet/core/thread_count.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

namespace ehdjet {
namespace {

struct Range {
  std::size_t begin = 0, end = 0;
  bool operator==(const Range&) const = default;
};

std::vector<Range> parts_of(std::size_t begin, std::size_t end) {
  std::array<Range, most_parts> parts{};
  std::array<int, most_parts> calls{};
  for_numbered_parts(begin, end, [&](std::size_t part, std::size_t from, std::size_t to) {
    parts.at(part) = {from, to}, ++calls.at(part);
  });
  std::vector<Range> found;
  for (std::size_t k = 0; k < most_parts; ++k) {
    EXPECT_LE(calls[k], 1) << k;
    if (calls[k] == 1) found.push_back(parts[k]);
  }
  return found;
}

constexpr std::array<std::size_t, 4> thread_counts{1, 2, 3, 7};

TEST(ForParts, a_short_range_is_one_part) {
  for (const std::size_t threads : thread_counts) {
    const ThreadCount count(threads);
    EXPECT_EQ(parts_of(5, 5 + parallel_from - 1),
              (std::vector<Range>{{5, 5 + parallel_from - 1}}));
    EXPECT_EQ(parts_of(5, 5), (std::vector<Range>{{5, 5}}));
    EXPECT_EQ(parts_of(5, 4), (std::vector<Range>{{5, 5}})); // no bead has a link
  }
}

TEST(ForParts, the_parts_of_a_long_range_follow_each_other_and_are_those_of_one_thread) {
  for (const std::size_t n : {parallel_from, parallel_from + 1, parallel_from + 127,
                              2 * parallel_from - 1, std::size_t{1'000'003}}) {
    std::vector<Range> alone;
    for (const std::size_t threads : thread_counts) {
      const ThreadCount count(threads);
      const std::vector<Range> parts = parts_of(3, 3 + n);
      std::size_t at = 3;
      for (const Range& part : parts) {
        EXPECT_EQ(part.begin, at);
        EXPECT_LE(part.begin, part.end);
        at = part.end;
      }
      EXPECT_EQ(at, 3 + n);
      if (threads == 1) alone = parts;
      EXPECT_EQ(parts, alone) << threads;
    }
  }
}

TEST(ForParts, every_entry_is_met_once) {
  for (const std::size_t threads : thread_counts) {
    const ThreadCount count(threads);
    for (const std::size_t n : {std::size_t{100}, parallel_from + 13, 10 * parallel_from}) {
      std::vector<int> met(n);
      for_parts(0, n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++met[i];
      });
      EXPECT_EQ(met, std::vector<int>(n, 1));
    }
  }
}

TEST(ThreadCount, lets_so_many_threads_run_whatever_the_load_and_then_restores) {
  const int threads = omp_get_max_threads(), dynamic = omp_get_dynamic();
  for (const bool by_load : {false, true}) {
    omp_set_dynamic(by_load ? 1 : 0);
    {
      const ThreadCount count(5); // more than there may be processors
      int team = 0;
#pragma omp parallel
#pragma omp single
      team = omp_get_num_threads();
      EXPECT_EQ(team, 5);
      EXPECT_EQ(omp_get_max_threads(), 5);
    }
    EXPECT_EQ(omp_get_dynamic() != 0, by_load);
    EXPECT_EQ(omp_get_max_threads(), threads);
  }
  omp_set_dynamic(dynamic);
}

TEST(ThreadCount, is_one_inside_a_parallel_region) {
  std::array<std::size_t, 2> granted{};
#pragma omp parallel num_threads(2)
  granted.at(static_cast<std::size_t>(omp_get_thread_num())) = granted_threads(4);
  EXPECT_EQ(granted, (std::array<std::size_t, 2>{1, 1}));
}

} // namespace
} // namespace ehdjet
