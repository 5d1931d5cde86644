#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace ehdjet {

/// A row of a tableau without its zeros, for sums over at most 16 vectors.
struct WeightedVectors {
  std::array<const double*, 16> vector{};
  std::array<double, 16> weight{};
  std::size_t count = 0;

  void add(const double* v, double w) {
    if (w == 0) return;
    vector[count] = v, weight[count] = w, ++count;
  }
};

inline bool is_finite(std::span<const double> y) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t i = 0; i < y.size(); ++i) sum += 0 * y[i];
  return sum == 0;
}

/// out = base + sum_j w_j v_j, two vectors a pass so that memory is not read once per vector.
inline void combine(const double* base, const WeightedVectors& sum, double* out,
                    std::size_t n) {
  std::size_t j = 0;
  const double* from = base;
  if (sum.count == 0 && out != base) std::copy_n(base, n, out);
  for (; j + 4 <= sum.count; j += 4, from = out) {
    const double *p = sum.vector[j], *q = sum.vector[j + 1], *r = sum.vector[j + 2],
                 *s = sum.vector[j + 3];
    const double a = sum.weight[j], b = sum.weight[j + 1], c = sum.weight[j + 2],
                 d = sum.weight[j + 3];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i)
      out[i] = from[i] + ((a * p[i] + b * q[i]) + (c * r[i] + d * s[i]));
  }
  for (; j + 2 <= sum.count; j += 2, from = out) {
    const double *p = sum.vector[j], *q = sum.vector[j + 1];
    const double a = sum.weight[j], b = sum.weight[j + 1];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) out[i] = from[i] + (a * p[i] + b * q[i]);
  }
  if (j < sum.count) {
    const double* p = sum.vector[j];
    const double a = sum.weight[j];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) out[i] = from[i] + a * p[i];
  }
}

} // namespace ehdjet
