#pragma once

#include <cmath>

namespace ehdjet {

/// A sum whose round-off does not grow with the number of terms, such as the time after millions
/// of steps or the mass of thousands of beads.
/// source : A. Neumaier, Z. Angew. Math. Mech. 54 (1974) 39
class CompensatedSum {
public:
  CompensatedSum(
      double start = 0) // NOLINT(google-explicit-constructor): stands for a number
      : sum_(start) {}
  /// The sum that had these parts.
  CompensatedSum(double leading, double carry)
      : sum_(leading)
      , carry_(carry) {}
  CompensatedSum& operator+=(double term) {
    const double next = sum_ + term;
    carry_ +=
        std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
    return *this;
  }
  operator double() const { return sum_ + carry_; } // NOLINT(google-explicit-constructor)
  [[nodiscard]] double leading() const { return sum_; }
  [[nodiscard]] double carry() const { return carry_; }

private:
  double sum_, carry_ = 0;
};

} // namespace ehdjet
