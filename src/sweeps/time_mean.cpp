#include "ehdjet/sweeps/time_mean.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace ehdjet {
namespace {

/// In steps, at least 1/2. `deviation`: values less their mean; not all of them are 0.
double autocorrelation_time(const std::vector<double>& deviation) {
  constexpr double window = 5; // times tau
  const std::size_t n = deviation.size();
  const auto correlation = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = lag; i < n; ++i) sum += deviation[i] * deviation[i - lag];
    return sum;
  };
  const double variance = correlation(0);
  double tau = 0.5;
  for (std::size_t lag = 1; lag < n && static_cast<double>(lag - 1) < window * tau; ++lag)
    tau += correlation(lag) / variance;
  // The means of a wave are better than those of independent values. Nothing is gained from that.
  return std::max(tau, 0.5);
}

} // namespace

TimeMean time_mean(std::span<const double> values) {
  EHDJET_EXPECTS(!values.empty());
  constexpr std::size_t fewest = 8;
  const auto n = static_cast<double>(values.size());
  TimeMean result{.mean = std::accumulate(values.begin(), values.end(), 0.0) / n,
                  .standard_error = {}};
  if (values.size() < fewest) return result;
  std::vector<double> deviation(values.begin(), values.end());
  double squares = 0;
  for (double& d : deviation) d -= result.mean, squares += d * d;
  result.standard_error = 0;
  if (squares > 0)
    result.standard_error =
        std::sqrt(2 * autocorrelation_time(deviation) * squares / (n * (n - 1)));
  return result;
}

} // namespace ehdjet
