#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace ehdjet {

/// How many of so many threads a parallel region gets here: no more than OMP_THREAD_LIMIT allows, and
/// one inside another parallel region.
inline std::size_t granted_threads(std::size_t asked) {
  if (omp_get_active_level() >= omp_get_max_active_levels()) return 1;
  return std::min(asked, static_cast<std::size_t>(omp_get_thread_limit()));
}

/// Sets the number of OpenMP threads, by default to that of OpenMP, as long as an object exists.
/// Results depend on this number in their last digits. Therefore OMP_DYNAMIC, by which it would
/// change with the load of the machine, is off meanwhile, and `omp_get_max_threads` returns the
/// number that runs.
class ThreadCount {
public:
  explicit ThreadCount(std::optional<std::size_t> asked) {
    omp_set_dynamic(0);
    omp_set_num_threads(static_cast<int>(
        granted_threads(asked.value_or(static_cast<std::size_t>(threads_before_)))));
  }
  ~ThreadCount() { omp_set_num_threads(threads_before_), omp_set_dynamic(dynamic_before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

private:
  int threads_before_ = omp_get_max_threads(), dynamic_before_ = omp_get_dynamic();
};

} // namespace ehdjet
