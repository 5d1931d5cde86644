#include "ehdjet/coulomb/error_estimate.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ehdjet {
namespace {

/// For fewer pairs, starting the threads takes longer than they save.
constexpr std::size_t parallel_from_pairs = 20000;

struct TargetError {
  long double error2, force2; ///< |dF|^2, |F|^2
  long double pair_sum;       ///< sum_j |f_ij|
};

TargetError error_of(std::size_t i, ConstVec3View r, std::span<const double> q,
                     ConstVec3View force) {
  using Real = long double;
  const PairSum<Real> sum = pair_sum<Real>(r[i], r, q, 0, q.size());
  const Real factor = constants::coulomb * Real(q[i]);
  const Real fx = factor * sum.x, fy = factor * sum.y, fz = factor * sum.z;
  const Real ex = force.x[i] - fx, ey = force.y[i] - fy, ez = force.z[i] - fz;
  return {ex * ex + ey * ey + ez * ez, fx * fx + fy * fy + fz * fz,
          std::abs(factor) * sum.magnitude};
}

double ratio(long double a, long double b) {
  return a == 0 ? 0 : static_cast<double>(a / b);
}

} // namespace

CoulombErrorSample sampled_error(const PointCharges& charges, ConstVec3View force,
                                 ToleranceNorm norm, std::size_t max_targets) {
  const ConstVec3View r = charges.r; // OpenMP cannot share a structured binding
  const std::span<const double> q = charges.q;
  const std::span<const std::uint8_t> moves = charges.moves;
  const std::size_t n = q.size();
  EHDJET_EXPECTS(r.x.size() == n && r.y.size() == n && r.z.size() == n);
  EHDJET_EXPECTS(force.x.size() == n && force.y.size() == n && force.z.size() == n);
  EHDJET_EXPECTS(max_targets > 0 && (moves.empty() || moves.size() == n));

  const bool some = norm == ToleranceNorm::moving && !moves.empty();
  std::vector<std::size_t> candidates; // only if some charges are no targets
  for (std::size_t i = 0; some && i < n; ++i)
    if (moves[i] != 0) candidates.push_back(i);
  const std::size_t among = some ? candidates.size() : n;
  std::vector<TargetError> errors(std::min(among, max_targets));
  const std::size_t targets = errors.size();
#pragma omp parallel for schedule(static) if (targets * n >= parallel_from_pairs)
  for (std::size_t k = 0; k < targets; ++k) {
    const std::size_t i = k * among / targets;
    errors[k] = error_of(some ? candidates[i] : i, r, q, force);
  }

  long double error2 = 0, force2 = 0, weaker2 = 0;
  CoulombErrorSample sample{.targets = targets};
  std::ranges::sort(errors, {}, &TargetError::force2);
  const std::size_t weaker = targets - targets / 10;
  std::vector<double> of_net; // without NaN, by which nothing can be sorted
  for (std::size_t k = 0; k < targets; ++k) {
    const TargetError& e = errors[k];
    error2 += e.error2, force2 += e.force2;
    if (k < weaker) weaker2 += e.force2;
    const double worst = ratio(std::sqrt(e.error2), e.pair_sum);
    // A NaN is taken over and stays, because nothing compares as greater.
    if (worst > sample.worst_per_target || std::isnan(worst))
      sample.worst_per_target = worst;
    const double net = ratio(std::sqrt(e.error2), std::sqrt(e.force2));
    if (std::isnan(net))
      sample.worst_of_net = net;
    else
      of_net.push_back(net);
  }
  sample.relative_l2 = ratio(std::sqrt(error2), std::sqrt(force2));
  if (targets > 0)
    sample.relative_moving = ratio(std::sqrt(error2 / static_cast<long double>(targets)),
                                   std::sqrt(weaker2 / static_cast<long double>(weaker)));
  std::ranges::sort(of_net);
  if (!of_net.empty()) {
    sample.median_of_net = of_net[of_net.size() / 2];
    if (!std::isnan(sample.worst_of_net)) sample.worst_of_net = of_net.back();
  }
  return sample;
}

} // namespace ehdjet
