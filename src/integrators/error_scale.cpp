#include "ehdjet/integrators/error_scale.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {

double ErrorScale::norm(std::span<const double> error, std::span<const double> y0,
                        std::span<const double> y1, std::size_t judged) const {
  EHDJET_EXPECTS(!column_scale.empty() && error.size() % column_scale.size() == 0);
  const std::size_t rows = error.size() / column_scale.size();
  judged = std::min(judged, rows);
  double largest = 0, squares = 0;
  for (std::size_t c = 0; c < column_scale.size(); ++c) {
    const double s = column_scale[c];
    const double *e = error.data() + c * rows, *a = y0.data() + c * rows,
                 *b = y1.data() + c * rows;
#pragma omp simd reduction(max : largest) reduction(+ : squares)
    for (std::size_t i = 0; i < judged; ++i) {
      const double size = std::max(std::abs(a[i]), std::abs(b[i]));
      const double ratio = std::abs(e[i]) / (s + size);
      largest = std::max(largest, ratio);
      squares +=
          ratio * ratio
          + 0 * b[i]; // not a number if the end is infinite, which would allow any error
    }
  }
  // std::max can lose a NaN; a sum keeps it.
  if (!std::isfinite(squares)) return squares;
  if (root_mean_square) {
    const auto count = static_cast<double>(judged * column_scale.size());
    largest = std::sqrt(squares / count);
  }
  return largest / rtol;
}

std::size_t ErrorScale::worst(std::span<const double> error, std::span<const double> y0,
                              std::span<const double> y1, std::size_t judged) const {
  const std::size_t rows = error.size() / column_scale.size();
  std::size_t worst = 0;
  double largest = -1;
  for (std::size_t i = 0; i < error.size(); ++i) {
    if (i % rows >= judged) continue;
    const double size = std::max(std::abs(y0[i]), std::abs(y1[i]));
    const double ratio = std::abs(error[i]) / (column_scale[i / rows] + size);
    if (!std::isfinite(ratio + 0 * y1[i])) return i;
    if (ratio > largest) largest = ratio, worst = i;
  }
  return worst;
}

} // namespace ehdjet
