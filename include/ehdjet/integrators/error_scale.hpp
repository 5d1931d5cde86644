#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace ehdjet {

/// How large an error may be. With the flat vector cut into `column_scale.size()` equal columns,
/// component i of column c is allowed
///
///     rtol (column_scale[c] + |y_i|)                                    (model 6)
///
/// so that metres and pascals do not share an absolute tolerance. The norm of an error vector is
/// the maximum (default) or the root mean square of error / allowed; up to 1 is accepted.
struct ErrorScale {
  double rtol = 1e-6;               ///< [-]
  std::vector<double> column_scale; ///< in the unit of the column
  bool root_mean_square = false;

  /// Norm of `error`, with |y| the larger of |y0|, |y1|. Not a number if any component is not.
  /// Of each column only the first `judged` rows count.
  [[nodiscard]] double norm(std::span<const double> error, std::span<const double> y0,
                            std::span<const double> y1,
                            std::size_t judged = all_rows) const;
  /// The same of an error that is never stored as a whole: `error(first, out)` writes its components
  /// from `first` on to `out`. It is called by several threads.
  using ErrorPart = std::function<void(std::size_t first, std::span<double> out)>;
  [[nodiscard]] double norm(const ErrorPart& error, std::span<const double> y0,
                            std::span<const double> y1,
                            std::size_t judged = all_rows) const;
  /// Component where error / allowed is largest or not a number.
  [[nodiscard]] std::size_t worst(std::span<const double> error, std::span<const double> y0,
                                  std::span<const double> y1,
                                  std::size_t judged = all_rows) const;

  static constexpr std::size_t all_rows = std::numeric_limits<std::size_t>::max();
};

} // namespace ehdjet
