#pragma once

#include <cstdint>

namespace ehdjet {

/// Multiples k*interval, k = first, first + 1, ..., computed without accumulating round-off.
class Schedule {
public:
  explicit Schedule(double interval, std::uint64_t first = 0)
      : interval_(interval)
      , count_(first) {}
  [[nodiscard]] double next() const { return static_cast<double>(count_) * interval_; }
  void advance() { ++count_; }

private:
  double interval_; // [s]
  std::uint64_t count_;
};

} // namespace ehdjet
