#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>

namespace ehdjet {

/// Below so many entries a loop is over before other threads have started.
inline constexpr std::size_t parallel_from = 16384;
/// Into so many parts a longer loop is cut, whatever the number of threads.
inline constexpr std::size_t most_parts = 128;

/// Calls `body(part, begin, end)` for contiguous parts of [begin, end), on all threads if the range is
/// long, else once, with part 0. Sums over each part that are then added in the order of the parts
/// have the same bits for any number of threads. `body` must not throw.
template <class Body>
void for_numbered_parts(std::size_t begin, std::size_t end, const Body& body) {
  const std::size_t n = end > begin ? end - begin : 0;
  if (n < parallel_from) {
    body(std::size_t{0}, begin, begin + n);
    return;
  }
  const std::size_t length = (n + most_parts - 1) / most_parts;
  const auto part = [&](std::size_t k) {
    const std::size_t from = std::min(begin + k * length, end);
    body(k, from, std::min(from + length, end));
  };
  if (omp_get_max_threads() == 1) {
    for (std::size_t k = 0; k < most_parts; ++k) part(k);
    return;
  }
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < most_parts; ++k) part(k);
}

/// Calls `body(begin, end)` in the same way, for loops in which no entry depends on another one.
template <class Body>
void for_parts(std::size_t begin, std::size_t end, const Body& body) {
  for_numbered_parts(
      begin, end,
      [&body](std::size_t /*part*/, std::size_t from, std::size_t to) { body(from, to); });
}

} // namespace ehdjet
