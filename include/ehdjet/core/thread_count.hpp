#pragma once

#include <omp.h>

#include <cstddef>
#include <optional>

namespace ehdjet {

/// Sets the number of OpenMP threads, if one is given, as long as an object exists.
class ThreadCount {
public:
  explicit ThreadCount(std::optional<std::size_t> threads) {
    if (threads) omp_set_num_threads(static_cast<int>(*threads));
  }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

private:
  int before_ = omp_get_max_threads();
};

} // namespace ehdjet
