#include "ehdjet/core/error.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "clusters.hpp"
#include "solvers.hpp"

namespace ehdjet::detail {
namespace {

/// The errors of many pairs of clusters add up in a force: at random or, on a ring, all with the
/// same sign. Each pair therefore gets a share of the tolerance that decreases with the number of
/// pairs that act on a charge. On a curve the force of a cluster of size s on its neighbours is
/// proportional to 1/s. If (s/d)^(p+2)/s is bounded, clusters of half the size have a ratio d/s, and
/// hence a number, that is larger by the factor 2^(1/(p+2)). The sum over the levels is a geometric
/// series. Even orders get a larger share than odd ones. The multipole of degree p is the first that
/// the expansions lack. On a smooth curve those of even degree act in opposite directions from both
/// sides of a charge. This does not hold for orders too low for the tolerance, which need many more
/// pairs. With this share the error is below the tolerance on jets, mostly a third to two thirds of
/// it, and below twice the tolerance on a ring, from 1e3 to 1e6 charges.
double margin_on_curves(std::size_t levels, const ClusterParameters& parameters) {
  const int order = parameters.order;
  const double ratio = std::exp2(1.0 / (order + 2));
  const double pairs = (std::pow(ratio, static_cast<double>(levels)) - 1) / (ratio - 1);
  const bool more = order % 2 == 0 && order > -std::log10(parameters.tolerance);
  return (more ? 8 : 5) / std::max(pairs, 8.0);
}
/// Charges that fill space have many more pairs. Those with a dense centre have many whose errors add
/// up around it.
constexpr double margin_in_space = 0.8, margin_in_uneven_space = 0.3;
/// The more sources there are for each target that is judged, the more charges a cluster of sources
/// has for one of targets, and the larger its error is compared with the forces on them.
double judged_per_source(const ClusterTree& targets, const ClusterTree& sources) {
  return std::min(1.0, targets.clusters().front().moving
                           / static_cast<double>(sources.charges()));
}

/// Root mean square of the net force on the targets that move. Errors are relative to it. Each force
/// call estimates it again from the forces on a few groups of charges, with multipoles of low order,
/// so that the result of a call depends only on its arguments.
class ForceScale {
public:
  ForceScale(const ExpansionKernel& kernel, int order)
      : expansions_(kernel, std::min(scale_order, order)) {}

  /// Every thread of the team must call it.
  void sample(const ClusterProblem& problem);
  /// The result without k_C, in the units of clusters. The few largest forces are left out, because
  /// a sample must not overestimate the number of such charges. For the norm `moving` the strongest
  /// tenth is left out, according to its definition.
  [[nodiscard]] double value(ToleranceNorm norm);

private:
  static constexpr int scale_order = 4; // of the multipoles
  static constexpr std::size_t most_groups = 16, charges_per_group = 128;
  static constexpr double opening = 0.4;

  void choose_groups(const ClusterProblem& problem);
  void add_field(const ClusterProblem& problem, std::uint32_t cluster, std::size_t begin);

  Expansions expansions_;
  std::vector<std::size_t> groups_;    ///< first charge of each sampled group
  std::vector<double> squares_;        ///< squares of the sampled forces
  std::vector<unsigned char> ignored_; ///< flags of close pairs, which are not used
};

// The groups are evenly spaced among the charges that move.
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
  std::erase(squares_, -1.0); // padding and charges at rest
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
    // The kernel leaves out close pairs, also that of a charge with itself.
    p.pairs.add_fields_one_way(c, g,
                               {begin / p.pairs.targets,
                                (begin + padding) / p.pairs.targets, 1, cluster.begin,
                                cluster.end},
                               ignored_.data());
  }
}

class ClusterSolver final : public CoulombSolver {
public:
  ClusterSolver(const Kernels& kernels, const ClusterParameters& parameters,
                std::unique_ptr<FarField> far_field)
      : kernels_(kernels)
      , parameters_(parameters)
      , expansions_(kernels.expansions, parameters.order)
      , multipoles_(expansions_)
      , of_targets_(expansions_)
      , scale_(kernels.expansions, parameters.order)
      , far_field_(std::move(far_field)) {
    EHDJET_EXPECTS(parameters.leaf > 0 && parameters.leaf % padding == 0);
    EHDJET_EXPECTS(parameters.opening > 0 && parameters.opening < 1);
    acceptance_ = {.opening = parameters.opening,
                   .order = parameters.order,
                   .per_bead = parameters.norm == ToleranceNorm::per_bead};
  }

  void add_force(const PointCharges& charges, Vec3View force) override {
    sum({&charges, 1}, force);
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    const PointCharges groups[]{sources, targets};
    sum(groups, force);
  }
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) const override {
    return cluster_energy(kernels_, parameters_, r, q);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override { return coincident_pairs_; }
  [[nodiscard]] CoulombAccuracy accuracy() const override {
    return {.tolerance = parameters_.tolerance, .norm = parameters_.norm};
  }
  [[nodiscard]] std::string_view name() const override { return far_field_->name(); }
  [[nodiscard]] std::string description() const override {
    return fmt::format(
        "{}, tolerance {:g}{}, order {}, leaves of {}", name(), parameters_.tolerance,
        parameters_.norm == ToleranceNorm::per_bead ? " per bead"
        : parameters_.norm == ToleranceNorm::moving ? " of the charges that move"
                                                    : "",
        parameters_.order, parameters_.leaf);
  }
  void tighten() override { strictness_ /= 2; }
  void archive(const Archive& a) override {
    a("strictness", strictness_);
    a.require("strictness", strictness_ > 0 && strictness_ <= 1, "is not between 0 and 1");
  }

private:
  void sum(std::span<const PointCharges> groups, Vec3View force) {
    coincident_pairs_ = 0;
    if (nothing_to_do(groups, force)) return;
    const bool mutual = groups.size() == 1;
    const std::size_t n = groups.back().size();
    const auto threads =
        static_cast<std::size_t>(threads_for(std::max(n, groups.front().size())));
    charges_.load(groups, threads, parameters_.norm == ToleranceNorm::moving);
    const Known sources{.identity = mutual ? nullptr : groups.front().identity,
                        .charges = groups.front().size(),
                        .scales = charges_.scales(),
                        .any_rests = charges_.moves() != nullptr};
    const bool known = sources.identity != nullptr && sources == known_;
    known_ = sources;
    if (known)
      clusters_[0].find_again(charges_, 0);
    else
      clusters_[0].find(charges_, 0, parameters_.leaf);
    if (!mutual) clusters_[1].find(charges_, 1, parameters_.leaf);
    acceptance_.uneven =
        !acceptance_.per_bead && (clusters_[0].uneven || (!mutual && clusters_[1].uneven));
    const ClusterProblem problem{.pairs = kernels_.pairs,
                                 .expansions = expansions_,
                                 .charges = charges_,
                                 .sources = clusters_[0].tree,
                                 .targets = clusters_[mutual ? 0 : 1].tree,
                                 .multipoles = multipoles_,
                                 .acceptance = acceptance_};
    multipoles_.reserve(problem.sources);
    if (!mutual) of_targets_.reserve(problem.targets);
    far_field_->reserve(problem, threads);
#pragma omp parallel num_threads(static_cast <int>(threads)) if (threads > 1)
    { // the runtime may grant fewer threads than asked for
      const auto team = static_cast<std::size_t>(omp_get_num_threads());
      const auto thread = static_cast<std::size_t>(omp_get_thread_num());
      if (!known) multipoles_.gather(problem.sources, charges_.columns());
      multipoles_.weigh(clusters_[0].tree, acceptance_.uneven);
      if (!mutual) {
        of_targets_.gather(problem.targets, charges_.columns());
        of_targets_.weigh(clusters_[1].tree, acceptance_.uneven);
      }
      if (!acceptance_.per_bead) scale_.sample(problem);
#pragma omp single
      acceptance_.allowed = allowed_error(mutual);
      charges_.clear_field(thread);
      far_field_->act(problem, thread, team);
#pragma omp barrier
      charges_.add_forces(team, n * thread / team, n * (thread + 1) / team, force);
    }
    coincident_pairs_ = charges_.add_close_pairs(force, far_field_->met_coincident());
  }

  /// What the tree and the multipoles of the sources depend on.
  struct Known {
    std::shared_ptr<const void> identity;
    std::size_t charges = 0;
    std::pair<double, double> scales;
    bool any_rests = false;
    bool operator==(const Known&) const = default;
  };

  double allowed_error(bool mutual) {
    const bool sorted = clusters_[0].sorted || (!mutual && clusters_[1].sorted);
    std::size_t levels = clusters_[0].tree.levels().size();
    if (!mutual) levels = std::max(levels, clusters_[1].tree.levels().size());
    const double margin =
        !sorted ? margin_on_curves(levels - 1, parameters_)
                : (acceptance_.uneven ? margin_in_uneven_space : margin_in_space);
    double allowed = margin * strictness_ * parameters_.tolerance;
    if (sorted && !acceptance_.per_bead)
      allowed *= judged_per_source(clusters_[mutual ? 0 : 1].tree, clusters_[0].tree);
    // Few sources may act on a charge through a single pair of clusters, whose error is not
    // averaged.
    if (acceptance_.per_bead && !mutual) allowed /= parameters_.order + 1;
    return acceptance_.per_bead ? allowed : allowed * scale_.value(parameters_.norm);
  }

  Kernels kernels_;
  ClusterParameters parameters_;
  Expansions expansions_;
  ScaledCharges charges_;
  Clusters clusters_[2];               ///< of sources and of targets
  Known known_;                        ///< of the last call
  Multipoles multipoles_, of_targets_; ///< the latter only for Multipoles::weigh
  ForceScale scale_;
  Acceptance acceptance_;
  std::unique_ptr<FarField> far_field_;
  double strictness_ = 1; ///< halved at each violation
  std::size_t coincident_pairs_ = 0;
};

} // namespace

std::unique_ptr<CoulombSolver> make_cluster_solver(const Kernels& kernels,
                                                   const ClusterParameters& parameters,
                                                   std::unique_ptr<FarField> far_field) {
  return std::make_unique<ClusterSolver>(kernels, parameters, std::move(far_field));
}

} // namespace ehdjet::detail
