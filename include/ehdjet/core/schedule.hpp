#pragma once

#include "ehdjet/core/checkpoint.hpp"

#include <cmath>
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
  /// The first one of those that are left that lies behind `time`, by more than round-off.
  [[nodiscard]] double next_after(double time) const {
    Schedule after = *this;
    while (after.next() <= time * (1 + 1e-12)) after.advance();
    return after.next();
  }
  /// Leaves out what lies before `time`.
  void skip_to(double time) {
    const double below =
        std::floor(time / interval_) - 1; // less by one, because of round-off
    if (below > static_cast<double>(count_)) count_ = static_cast<std::uint64_t>(below);
    while (next() < time) advance();
  }
  void archive(const Archive& a) { a("count", count_); }

private:
  double interval_; // [s]
  std::uint64_t count_;
};

} // namespace ehdjet
