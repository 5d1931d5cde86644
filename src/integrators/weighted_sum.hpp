#pragma once

#include "ehdjet/core/parallel.hpp"

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
  std::array<double, most_parts> sums{};
  for_numbered_parts(0, y.size(),
                     [&](std::size_t part, std::size_t begin, std::size_t end) {
                       double sum = 0;
#pragma omp simd reduction(+ : sum)
                       for (std::size_t i = begin; i < end; ++i) sum += 0 * y[i];
                       sums[part] = sum;
                     });
  return std::ranges::all_of(sums, [](double sum) { return sum == 0; });
}

/// sum + w_J v_J[i] + ... + w_(N-1) v_(N-1)[i], added in fours, then two, then one.
template <std::size_t N, std::size_t J = 0>
inline double added(double sum, const std::array<const double*, N>& v,
                    const std::array<double, N>& w, std::size_t i) {
  if constexpr (J + 4 <= N)
    return added<N, J + 4>(sum
                               + ((w[J] * v[J][i] + w[J + 1] * v[J + 1][i])
                                  + (w[J + 2] * v[J + 2][i] + w[J + 3] * v[J + 3][i])),
                           v, w, i);
  else if constexpr (J + 2 <= N)
    return added<N, J + 2>(sum + (w[J] * v[J][i] + w[J + 1] * v[J + 1][i]), v, w, i);
  else if constexpr (J < N)
    return sum + w[J] * v[J][i];
  else
    return sum;
}

/// out[i] = from[i] + w_j v_j[first + i] + ... for N vectors from the j-th on, in one pass.
template <std::size_t N>
void combine_pass(const double* from, const WeightedVectors& sum, std::size_t j,
                  std::size_t first, std::span<double> out) {
  std::array<const double*, N> v;
  std::array<double, N> w;
  for (std::size_t k = 0; k < N; ++k)
    v[k] = sum.vector[j + k] + first, w[k] = sum.weight[j + k];
  double* to = out.data();
#pragma omp simd
  for (std::size_t i = 0; i < out.size(); ++i) to[i] = added<N>(from[i], v, w, i);
}

/// out[i] = from[i] + sum_j w_j v_j[first + i]: one pass, and one more from nine vectors on.
inline void combine_block(const double* from, const WeightedVectors& sum, std::size_t first,
                          std::span<double> out) {
  constexpr std::array pass{combine_pass<1>, combine_pass<2>, combine_pass<3>,
                            combine_pass<4>, combine_pass<5>, combine_pass<6>,
                            combine_pass<7>, combine_pass<8>};
  if (sum.count == 0 && out.data() != from) std::copy_n(from, out.size(), out.data());
  for (std::size_t j = 0; j < sum.count; j += pass.size(), from = out.data())
    pass[std::min(sum.count - j, pass.size()) - 1](from, sum, j, first, out);
}

/// out[i] = sum_j w_j v_j[first + i].
inline void combine_block(const WeightedVectors& sum, std::size_t first,
                          std::span<double> out) {
  std::ranges::fill(out, 0.0);
  combine_block(out.data(), sum, first, out);
}

/// out = base + sum_j w_j v_j.
inline void combine(const double* base, const WeightedVectors& sum, double* out,
                    std::size_t n) {
  for_parts(0, n, [&](std::size_t begin, std::size_t end) {
    combine_block(base + begin, sum, begin, {out + begin, end - begin});
  });
}

} // namespace ehdjet
