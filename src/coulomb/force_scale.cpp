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

void ForceScale::sample(const ClusterProblem& p) {
  const std::size_t n = p.targets.charges(), groups = (n + padding - 1) / padding;
  const std::size_t sampled =
      std::min(groups, std::clamp<std::size_t>(n / charges_per_group, 4, most_groups));
#pragma omp single
  {
    squares_.assign(sampled * padding, -1.0);
    if (ignored_.size() < p.charges.length()) ignored_.resize(p.charges.length());
  }
  const ChargeColumns c = p.charges.columns();
  const FieldColumns g = p.charges.field(0);
  constexpr double unit = ExpansionKernel::unit;
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < sampled; ++k) {
    const std::size_t begin =
        p.targets.begin() + groups * (2 * k + 1) / (2 * sampled) * padding;
    for (double* column : {g.x, g.y, g.z}) std::fill_n(column + begin, padding, 0.0);
    add_field(p, 0, begin);
    for (std::size_t i = begin; i < std::min(begin + padding, p.targets.begin() + n); ++i) {
      const double f = c.q[i] / (unit * unit);
      const double fx = f * g.x[i], fy = f * g.y[i], fz = f * g.z[i];
      squares_[k * padding + i - begin] = fx * fx + fy * fy + fz * fz;
    }
  }
}

double ForceScale::value() {
  std::erase(squares_, -1.0); // places behind the last charge
  std::ranges::sort(squares_);
  const std::size_t kept = squares_.size() - squares_.size() / 32;
  const double sum = std::accumulate(
      squares_.begin(), squares_.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
  return std::sqrt(sum / static_cast<double>(squares_.size()));
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
