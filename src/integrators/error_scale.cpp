#include "ehdjet/integrators/error_scale.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ehdjet {
namespace {

/// Of components of the error over what they are allowed, but for rtol.
struct Ratios {
  double largest = 0, squares = 0;

  void add(double scale, const double* error, const double* y0, const double* y1,
           std::size_t n) {
    double most = largest, sum = squares;
#pragma omp simd reduction(max : most) reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) {
      const double size = std::max(std::abs(y0[i]), std::abs(y1[i]));
      const double ratio = std::abs(error[i]) / (scale + size);
      most = std::max(most, ratio);
      sum +=
          ratio * ratio
          + 0 * y1[i]; // not a number if the end is infinite, which would allow any error
    }
    largest = most, squares = sum;
  }
  void add(const Ratios& other) {
    largest = std::max(largest, other.largest), squares += other.squares;
  }
};

/// Sums are over the same blocks whatever the number of threads. `errors(first, room)` are those of
/// `room.size()` components, which it may write to `room`.
template <class Errors>
double norm_of(const ErrorScale& scale, std::span<const double> y0,
               std::span<const double> y1, std::size_t judged, const Errors& errors) {
  const auto& columns = scale.column_scale;
  EHDJET_EXPECTS(!columns.empty() && y0.size() % columns.size() == 0);
  const std::size_t rows = y0.size() / columns.size();
  judged = std::min(judged, rows);
  constexpr std::size_t block = 2048;
  std::array<Ratios, most_parts> parts{};
  for_numbered_parts(
      0, y0.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
        std::array<double, block> room; // NOLINT(cppcoreguidelines-pro-type-member-init)
        Ratios ratios;
        for (std::size_t i = begin; i < end;) {
          const std::size_t column = i / rows, row = i % rows;
          const std::size_t length = std::min({block, end - i, rows - row});
          if (row < judged) {
            const std::size_t n = std::min(length, judged - row);
            const double* error = errors(i, std::span(room.data(), n));
            ratios.add(columns[column], error, y0.data() + i, y1.data() + i, n);
          }
          i += length;
        }
        parts[part] = ratios;
      });
  Ratios all;
  for (const Ratios& part : parts) all.add(part);
  // std::max can lose a NaN; a sum keeps it.
  if (!std::isfinite(all.squares)) return all.squares;
  if (scale.root_mean_square) {
    const auto count = static_cast<double>(judged * columns.size());
    all.largest = std::sqrt(all.squares / count);
  }
  return all.largest / scale.rtol;
}

} // namespace

double ErrorScale::norm(std::span<const double> error, std::span<const double> y0,
                        std::span<const double> y1, std::size_t judged) const {
  EHDJET_EXPECTS(error.size() == y0.size());
  return norm_of(*this, y0, y1, judged,
                 [error](std::size_t first, std::span<double> /*room*/) {
                   return error.data() + first;
                 });
}

double ErrorScale::norm(const ErrorPart& error, std::span<const double> y0,
                        std::span<const double> y1, std::size_t judged) const {
  return norm_of(*this, y0, y1, judged,
                 [&error](std::size_t first, std::span<double> room) {
                   error(first, room);
                   return room.data();
                 });
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
