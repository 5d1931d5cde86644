#include "cluster_solver.hpp"

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/error.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace ehdjet::detail {
namespace {

/// Below this many charges starting the threads costs more than they save.
constexpr std::size_t parallel_from = 1024;

/// Order of the multipoles, and number of groups of charges, from which the scale of the force is
/// estimated.
constexpr int scale_order = 4;
constexpr std::size_t scale_groups = 16, charges_per_scale_group = 128;
constexpr double scale_opening = 0.4;

/// Errors of many pairs add up in a force: at random or, on a ring, all with the same sign. So
/// each pair gets a share of the tolerance that falls with the number of pairs that act on a
/// charge. On a curve the force of a cluster of size s on its neighbours goes with 1/s, so that
/// under a bound for the error, (s/d)^(p+2)/s, clusters of half the size have their distance d/s,
/// and with it their number, larger by 2^(1/(p+2)): a geometric series over the levels. With this
/// factor the error stays below half the tolerance on jets and below twice the tolerance on a
/// ring, from 1e3 to 1e6 charges.
double margin_on_curves(std::size_t levels, int order) {
  const double ratio = std::exp2(1.0 / (order + 2));
  const double pairs = (std::pow(ratio, static_cast<double>(levels)) - 1) / (ratio - 1);
  return 5 / std::max(pairs, 8.0);
}
/// Charges that fill space have many more pairs.
constexpr double margin_in_space = 0.2;

double power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

/// Bits of three numbers of 21 bits each, interleaved: neighbours in space are mostly neighbours
/// in this order (Morton's).
std::uint64_t interleaved(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 32U) & 0x1f00000000ffffU;
    v = (v | v << 16U) & 0x1f0000ff0000ffU;
    v = (v | v << 8U) & 0x100f00f00f00f00fU;
    v = (v | v << 4U) & 0x10c30c30c30c30c3U;
    return (v | v << 2U) & 0x1249249249249249U;
  };
  return spread(x) | spread(y) << 1U | spread(z) << 2U;
}

} // namespace

struct ClusterSolver::Sorted {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys; // place on the curve, index
  std::array<std::vector<double>, 7> columns;                // x, y, z, q, force
};

ClusterSolver::ClusterSolver(const Kernels& kernels, const ClusterParameters& parameters)
    : pairs_(kernels.pairs)
    , kernel_(kernels.expansions)
    , parameters_(parameters)
    , tables_(parameters.order)
    , numbers_(tables_.numbers())
    , set_(coefficients(parameters.order))
    , charges_(kernels.pairs.targets)
    , scale_tables_(std::min(scale_order, parameters.order))
    , scale_numbers_(scale_tables_.numbers()) {
  EHDJET_EXPECTS(parameters.leaf > 0 && parameters.leaf % padding == 0);
  EHDJET_EXPECTS(parameters.opening > 0 && parameters.opening < 1);
}

ClusterSolver::~ClusterSolver() = default;

void ClusterSolver::add_force(ConstVec3View r, std::span<const double> q, Vec3View force) {
  const std::size_t n = q.size();
  EHDJET_EXPECTS(r.x.size() == n && r.y.size() == n && r.z.size() == n);
  EHDJET_EXPECTS(force.x.size() == n && force.y.size() == n && force.z.size() == n);
  EHDJET_EXPECTS(n < (std::size_t{1} << 31U));
  coincident_pairs_ = 0;
  if (n == 0) return;
  charges_.reserve(n,
                   static_cast<std::size_t>(n < parallel_from ? 1 : omp_get_max_threads()));
  charges_.load(r, q);
  tree_.shape(n, parameters_.leaf);
  tree_.bound(charges_.columns());
  sorted_now_ = !is_ordered();
  if (!sorted_now_) {
    compute(r, q, force);
    return;
  }
  sort(r, q);
  auto& [x, y, z, charge, fx, fy, fz] = sorted_->columns;
  charges_.load({x, y, z}, charge);
  tree_.bound(charges_.columns());
  compute({x, y, z}, charge, {fx, fy, fz});
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t k = sorted_->keys[i].second;
    force.x[k] += fx[i], force.y[k] += fy[i], force.z[k] += fz[i];
  }
}

void ClusterSolver::compute(ConstVec3View r, std::span<const double> q, Vec3View force) {
  const std::size_t n = q.size();
  const auto threads =
      static_cast<std::size_t>(n < parallel_from ? 1 : omp_get_max_threads());
  const std::size_t numbers = set_ * tree_.clusters().size();
  if (multipoles_.size() < numbers) multipoles_.resize(numbers);
  reserve(threads);
#pragma omp parallel num_threads(static_cast <int>(threads)) if (threads > 1)
  { // the runtime may grant fewer threads than asked for
    const auto team = static_cast<std::size_t>(omp_get_num_threads());
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    gather_multipoles();
    if (parameters_.norm == ToleranceNorm::global) sample_forces();
#pragma omp single
    {
      const double margin =
          sorted_now_ ? margin_in_space
                      : margin_on_curves(tree_.levels().size() - 1, parameters_.order);
      allowed_ = margin * strictness_ * parameters_.tolerance;
      if (parameters_.norm == ToleranceNorm::global) allowed_ *= force_scale();
    }
    plan(thread, team);
    charges_.clear_field(thread);
    act(thread, team);
#pragma omp barrier
    charges_.add_forces(team, n * thread / team, n * (thread + 1) / team, force);
  }
  coincident_pairs_ = charges_.add_close_pairs(r, q, force);
}

// Both solvers alike, as a treecode: each leaf's charges in the potentials of far clusters'
// multipoles.
double ClusterSolver::energy(ConstVec3View r, std::span<const double> q) {
  const std::size_t n = q.size();
  EHDJET_EXPECTS(r.x.size() == n && r.y.size() == n && r.z.size() == n);
  EHDJET_EXPECTS(n < (std::size_t{1} << 31U));
  if (n == 0) return 0;
  const int threads = n < parallel_from ? 1 : omp_get_max_threads();
  charges_.reserve(n, static_cast<std::size_t>(threads));
  charges_.load(r, q);
  tree_.shape(n, parameters_.leaf);
  tree_.bound(charges_.columns());
  if (!is_ordered()) {
    sort(r, q);
    const auto& [x, y, z, charge, fx, fy, fz] = sorted_->columns;
    charges_.load({x, y, z}, charge);
    tree_.bound(charges_.columns());
  }
  const std::size_t numbers = set_ * tree_.clusters().size();
  if (multipoles_.size() < numbers) multipoles_.resize(numbers);
  const auto leaves = tree_.leaves();
  energies_.resize(leaves.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    gather_multipoles();
#pragma omp for schedule(dynamic, 4)
    for (std::size_t i = 0; i < leaves.size(); ++i) energies_[i] = energy_of(leaves[i], 0);
  }
  CompensatedSum sum;
  for (const double e : energies_) sum += e;
  return charges_.energy(sum / 2); // each pair was met from both sides
}

// Of the charges of a leaf in the field of a cluster. A cluster is far if the tail of its series
// is below the tolerance relative to its potential: the energies of pairs of like charges do not
// cancel.
double ClusterSolver::energy_of(std::uint32_t leaf, std::uint32_t source) {
  const Cluster &target = tree_.clusters()[leaf], &cluster = tree_.clusters()[source];
  const ChargeColumns c = charges_.columns();
  constexpr double unit = ExpansionKernel::unit;
  const double theta =
      cluster.radius / (between(cluster.centre, target.centre).norm() - target.radius);
  if (theta >= 0 && theta < parameters_.opening
      && power(theta, parameters_.order + 1) <= (1 - theta) * parameters_.tolerance)
    return unit
           * kernel_.energy_in_multipole(numbers_, c, target.begin, target.end,
                                         cluster.centre, multipole(source));
  if (!cluster.is_leaf())
    return energy_of(leaf, cluster.child) + energy_of(leaf, cluster.child + 1);
  double sum = 0;
  const std::size_t n = tree_.charges();
  const std::size_t last = std::min<std::size_t>(cluster.end, n);
  for (std::size_t i = target.begin; i < std::min<std::size_t>(target.end, n); ++i) {
    const double x = c.x[i], y = c.y[i], z = c.z[i];
    double potential = 0;
#pragma omp simd reduction(+ : potential)
    for (std::size_t j = cluster.begin; j < last; ++j) {
      const double dx = x - c.x[j], dy = y - c.y[j], dz = z - c.z[j];
      const double square = dx * dx + dy * dy + dz * dz;
      potential += square > 0 ? c.q[j] / std::sqrt(square) : 0.0;
    }
    sum += c.q[i] * potential;
  }
  return sum;
}

std::string ClusterSolver::description() const {
  return fmt::format("{}, tolerance {:g}{}, order {}, leaves of {}", name(),
                     parameters_.tolerance,
                     parameters_.norm == ToleranceNorm::per_bead ? " per bead" : "",
                     parameters_.order, parameters_.leaf);
}

/// Leaves of a curve are much smaller than those of charges that fill space with as many leaves;
/// leaves of charges in no order are as large as everything.
bool ClusterSolver::is_ordered() const {
  const auto clusters = tree_.clusters();
  const auto leaves = tree_.leaves();
  constexpr std::size_t too_few = 16;
  if (leaves.size() < too_few) return true;
  double sum = 0;
  for (const std::uint32_t leaf : leaves) sum += clusters[leaf].radius;
  const auto number = static_cast<double>(leaves.size());
  return sum / number <= 1.5 * clusters[0].radius / std::cbrt(number);
}

void ClusterSolver::sort(ConstVec3View r, std::span<const double> q) {
  if (!sorted_) sorted_ = std::make_unique<Sorted>();
  const std::size_t n = q.size();
  auto& keys = sorted_->keys;
  keys.resize(n);
  const Cluster& all = tree_.clusters()[0];
  const ChargeColumns c = charges_.columns();
  const double size = std::max({all.high[0] - all.low[0], all.high[1] - all.low[1],
                                all.high[2] - all.low[2], 1e-300});
  const double cells = 0x1fffff / size;
  for (std::size_t i = 0; i < n; ++i) {
    const auto cell = [&](const double* column, int k) {
      return static_cast<std::uint64_t>((column[i] * ExpansionKernel::unit - all.low[k])
                                        * cells);
    };
    keys[i] = {interleaved(cell(c.x, 0), cell(c.y, 1), cell(c.z, 2)),
               static_cast<std::uint32_t>(i)};
  }
  std::ranges::sort(keys);
  for (auto& column : sorted_->columns) column.assign(n, 0.0);
  auto& [x, y, z, charge, fx, fy, fz] = sorted_->columns;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t k = keys[i].second;
    x[i] = r.x[k], y[i] = r.y[k], z[i] = r.z[k], charge[i] = q[k];
  }
}

// From and to a set that nobody looks at.
ExpansionKernel::Batch ClusterSolver::idle_batch() {
  static const std::array<double, coefficients(highest_order)> zero{};
  thread_local std::array<double, coefficients(highest_order)> nowhere{};
  ExpansionKernel::Batch batch{};
  for (std::size_t lane = 0; lane < ExpansionKernel::most_lanes; ++lane) {
    for (std::size_t side = 0; side < 2; ++side)
      batch.from[side][lane] = zero.data(), batch.to[side][lane] = nowhere.data();
    batch.dz[lane] = 1;
  }
  return batch;
}

void ClusterSolver::set_lane(ExpansionKernel::Batch& batch, std::size_t lane,
                             const double* from, double* to, const Displacement& d) {
  batch.from[0][lane] = from, batch.to[0][lane] = to;
  batch.dx[lane] = d.x, batch.dy[lane] = d.y, batch.dz[lane] = d.z;
}

// Leaves from their charges, parents from their children, level after level upwards.
void ClusterSolver::gather_multipoles() {
  const auto clusters = tree_.clusters();
  const auto leaves = tree_.leaves();
#pragma omp for schedule(static)
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Cluster& leaf = clusters[leaves[i]];
    kernel_.charges_to_multipole(numbers_, charges_.columns(), leaf.begin,
                                 std::min<std::size_t>(leaf.end, tree_.charges()),
                                 leaf.centre, multipole(leaves[i]));
  }
  for (std::size_t level = tree_.levels().size() - 1; level-- > 0;)
    shift_level(level, multipoles_.data(), Shift::upward);
}

void ClusterSolver::shift_level(std::size_t level, double* expansions, Shift direction) {
  const auto clusters = tree_.clusters();
  const std::size_t begin = tree_.levels()[level], end = tree_.levels()[level + 1];
  const std::size_t parents = kernel_.lanes / 2; // per batch
#pragma omp for schedule(static)
  for (std::size_t first = begin; first < end; first += parents) {
    ExpansionKernel::Batch batch = idle_batch();
    for (std::size_t k = 0; k < parents && first + k < end; ++k) {
      const Cluster& parent = clusters[first + k];
      if (parent.is_leaf()) continue;
      double* own = expansions + set_ * (first + k);
      if (direction == Shift::upward) std::fill_n(own, set_, 0.0);
      for (std::size_t c = 0; c < 2; ++c) {
        const Cluster& child = clusters[parent.child + c];
        double* childs = expansions + set_ * (parent.child + c);
        if (direction == Shift::upward)
          set_lane(batch, 2 * k + c, childs, own, between(child.centre, parent.centre));
        else
          set_lane(batch, 2 * k + c, own, childs, between(parent.centre, child.centre));
      }
    }
    (direction == Shift::upward ? kernel_.shift_multipoles : kernel_.shift_locals)(numbers_,
                                                                                   batch);
  }
}

bool ClusterSolver::accepted(const Cluster& source, const Cluster& target,
                             bool mutual) const {
  const double d = between(source.centre, target.centre).norm();
  const double to_target = d - target.radius, to_source = d - source.radius;
  const double theta = parameters_.opening;
  if (!(source.radius < theta * to_target)) return false;
  if (mutual && !(target.radius < theta * to_source)) return false;
  const int p = parameters_.order;
  // The field of a multipole of order p, or the pair of series that makes the mutual force.
  double tail = power(source.radius / to_target, mutual ? p : p + 1);
  if (mutual) tail += power(target.radius / to_source, p);
  if (parameters_.norm == ToleranceNorm::per_bead) return tail <= allowed_;
  double force = source.charge * std::sqrt(target.square);
  if (mutual) force = std::max(force, target.charge * std::sqrt(source.square));
  return force * tail <= allowed_ * d * d;
}

/// Squares of the forces on a few groups of charges, by low multipoles and nearby charges.
void ClusterSolver::sample_forces() {
  const std::size_t n = tree_.charges(), groups = (n + padding - 1) / padding;
  const std::size_t sampled = std::min(
      groups, std::clamp<std::size_t>(n / charges_per_scale_group, 4, scale_groups));
#pragma omp single
  {
    squares_.assign(sampled * padding, -1.0);
    if (ignored_.size() < charges_.length()) ignored_.resize(charges_.length());
  }
  const ChargeColumns c = charges_.columns();
  const FieldColumns g = charges_.field(0);
  constexpr double unit = ExpansionKernel::unit;
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < sampled; ++k) {
    const std::size_t begin = groups * (2 * k + 1) / (2 * sampled) * padding;
    for (double* column : {g.x, g.y, g.z}) std::fill_n(column + begin, padding, 0.0);
    sample_field(0, begin);
    for (std::size_t i = begin; i < std::min(begin + padding, n); ++i) {
      const double f = c.q[i] / (unit * unit);
      const double fx = f * g.x[i], fy = f * g.y[i], fz = f * g.z[i];
      squares_[k * padding + i - begin] = fx * fx + fy * fy + fz * fz;
    }
  }
}

/// Root mean square of the net force, without k_C, in the units of clusters. The largest few do not
/// count: if a few charges have nearly all of the force, a sample must not take them for typical.
double ClusterSolver::force_scale() {
  std::erase(squares_, -1.0); // places behind the last charge
  std::ranges::sort(squares_);
  const std::size_t kept = squares_.size() - squares_.size() / 32;
  const double sum = std::accumulate(
      squares_.begin(), squares_.begin() + static_cast<std::ptrdiff_t>(kept), 0.0);
  return std::sqrt(sum / static_cast<double>(squares_.size()));
}

void ClusterSolver::sample_field(std::uint32_t at, std::size_t begin) {
  const Cluster& cluster = tree_.clusters()[at];
  const ChargeColumns c = charges_.columns();
  const FieldColumns g = charges_.field(0);
  constexpr double unit = ExpansionKernel::unit;
  const std::size_t group_end = std::min(begin + padding, tree_.charges());
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < group_end; ++i) {
    const double place[3] = {c.x[i] * unit, c.y[i] * unit, c.z[i] * unit};
    nearest = std::min(nearest, between(cluster.centre, place).norm());
  }
  if (cluster.radius < scale_opening * nearest) {
    std::array<double, 3 * coefficients(scale_order + 1)> gradient;
    kernel_.multipole_gradient(scale_numbers_, multipole(at), gradient.data());
    kernel_.multipole_to_charges(scale_numbers_, c, g, begin, begin + padding,
                                 cluster.centre, gradient.data());
  } else if (!cluster.is_leaf()) {
    sample_field(cluster.child, begin), sample_field(cluster.child + 1, begin);
  } else {
    // Leaves out close pairs, a charge and itself among them.
    pairs_.add_fields_one_way(c, g,
                              {begin / pairs_.targets, (begin + padding) / pairs_.targets,
                               1, cluster.begin, cluster.end},
                              ignored_.data());
  }
}

} // namespace ehdjet::detail
