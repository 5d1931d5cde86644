#include "force_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace ehdjet::detail {
namespace {

/// Order of the multipoles, and number of groups of charges.
constexpr int scale_order = 4;
constexpr std::size_t most_groups = 16, charges_per_group = 128;
constexpr double opening = 0.4;

} // namespace

ForceScale::ForceScale(const ExpansionKernel& kernel, int order)
    : expansions_(kernel, std::min(scale_order, order)) {}

// Evenly spaced along the charges that move.
void ForceScale::choose_groups(const ClusterProblem& p) {
  const std::uint8_t* moves = p.charges.moves();
  const std::size_t begin = p.targets.begin(), end = begin + p.targets.charges();
  const std::size_t groups = (end - begin + padding - 1) / padding;
  const std::size_t moving =
      moves == nullptr
          ? end - begin
          : static_cast<std::size_t>(std::count(moves + begin, moves + end, 1));
  const std::size_t sampled =
      std::min(groups, std::clamp<std::size_t>(moving / charges_per_group, 4, most_groups));
  groups_.clear();
  if (moves == nullptr)
    for (std::size_t k = 0; k < sampled; ++k)
      groups_.push_back(begin + groups * (2 * k + 1) / (2 * sampled) * padding);
  std::size_t met = 0, k = 0;
  for (std::size_t i = begin; moves != nullptr && i < end; ++i) {
    if (moves[i] == 0 || met++ != moving * (2 * k + 1) / (2 * sampled)) continue;
    const std::size_t group = i / padding * padding;
    if (groups_.empty() || groups_.back() != group) groups_.push_back(group);
    while (k < sampled && moving * (2 * k + 1) / (2 * sampled) < met) ++k;
  }
  squares_.assign(groups_.size() * padding, -1.0);
  if (ignored_.size() < p.charges.length()) ignored_.resize(p.charges.length());
}

void ForceScale::sample(const ClusterProblem& p) {
#pragma omp single
  choose_groups(p);
  const ChargeColumns c = p.charges.columns();
  const FieldColumns g = p.charges.field(0);
  const std::uint8_t* moves = p.charges.moves();
  constexpr double unit = ExpansionKernel::unit;
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const std::size_t begin = groups_[k],
                      end = std::min(begin + padding,
                                     p.targets.begin() + p.targets.charges());
    for (double* column : {g.x, g.y, g.z}) std::fill_n(column + begin, padding, 0.0);
    add_field(p, 0, begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (moves != nullptr && moves[i] == 0) continue;
      const double f = c.q[i] / (unit * unit);
      const double fx = f * g.x[i], fy = f * g.y[i], fz = f * g.z[i];
      squares_[k * padding + i - begin] = fx * fx + fy * fy + fz * fz;
    }
  }
}

double ForceScale::value(ToleranceNorm norm) {
  std::erase(squares_, -1.0); // places behind the last charge, and charges that rest
  if (squares_.empty()) return 0;
  std::ranges::sort(squares_);
  const bool moving = norm == ToleranceNorm::moving;
  const std::size_t kept = squares_.size() - squares_.size() / (moving ? 10 : 32);
  const double sum = std::accumulate(
      squares_.begin(), squares_.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
  return std::sqrt(sum / static_cast<double>(moving ? kept : squares_.size()));
}

void ForceScale::add_field(const ClusterProblem& p, std::uint32_t at, std::size_t begin) {
  const Cluster& cluster = p.sources.clusters()[at];
  const ChargeColumns c = p.charges.columns();
  const FieldColumns g = p.charges.field(0);
  constexpr double unit = ExpansionKernel::unit;
  const std::size_t end =
      std::min(begin + padding, p.targets.begin() + p.targets.charges());
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; ++i) {
    const double place[3] = {c.x[i] * unit, c.y[i] * unit, c.z[i] * unit};
    nearest = std::min(nearest, between(cluster.centre, place).norm());
  }
  if (cluster.radius < opening * nearest) {
    std::array<double, 3 * coefficients(scale_order + 1)> gradient;
    expansions_.kernel.multipole_gradient(expansions_.numbers, p.multipoles[at],
                                          gradient.data());
    expansions_.kernel.multipole_to_charges(
        expansions_.numbers, c, g, begin, begin + padding, cluster.centre, gradient.data());
  } else if (!cluster.is_leaf()) {
    add_field(p, cluster.child, begin), add_field(p, cluster.child + 1, begin);
  } else {
    // Leaves out close pairs, a charge and itself among them.
    p.pairs.add_fields_one_way(c, g,
                               {begin / p.pairs.targets,
                                (begin + padding) / p.pairs.targets, 1, cluster.begin,
                                cluster.end},
                               ignored_.data());
  }
}

} // namespace ehdjet::detail
