#include "cluster_solver.hpp"

#include "ehdjet/core/error.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "cluster_energy.hpp"
#include "clusters.hpp"
#include "force_scale.hpp"

namespace ehdjet::detail {
namespace {

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
/// Charges that fill space have many more pairs, and a few that move among many that rest feel these
/// with net forces that are small against each of them.
constexpr double margin_in_space = 0.2, margin_among_resting = 0.01;

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
  void archive(const Archive& a) override { a("strictness", strictness_); }

private:
  void sum(std::span<const PointCharges> groups, Vec3View force) {
    coincident_pairs_ = 0;
    if (nothing_to_do(groups, force)) return;
    const bool mutual = groups.size() == 1;
    const std::size_t n = groups.back().size();
    const auto threads =
        static_cast<std::size_t>(threads_for(std::max(n, groups.front().size())));
    charges_.load(groups, threads, parameters_.norm == ToleranceNorm::moving);
    clusters_[0].find(charges_, 0, parameters_.leaf);
    if (!mutual) clusters_[1].find(charges_, 1, parameters_.leaf);
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
      multipoles_.gather(problem.sources, charges_.columns());
      multipoles_.weigh(clusters_[0].tree);
      if (!mutual) {
        of_targets_.gather(problem.targets, charges_.columns());
        of_targets_.weigh(clusters_[1].tree);
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

  double allowed_error(bool mutual) {
    const bool sorted = clusters_[0].sorted || (!mutual && clusters_[1].sorted);
    std::size_t levels = clusters_[0].tree.levels().size();
    if (!mutual) levels = std::max(levels, clusters_[1].tree.levels().size());
    const double margin = !sorted ? margin_on_curves(levels - 1, parameters_.order)
                          : charges_.moves() == nullptr ? margin_in_space
                                                        : margin_among_resting;
    double allowed = margin * strictness_ * parameters_.tolerance;
    // A few sources act on a charge through one pair of clusters only: nothing averages its error.
    if (acceptance_.per_bead && !mutual) allowed /= parameters_.order + 1;
    return acceptance_.per_bead ? allowed : allowed * scale_.value(parameters_.norm);
  }

  Kernels kernels_;
  ClusterParameters parameters_;
  Expansions expansions_;
  ScaledCharges charges_;
  Clusters clusters_[2];               ///< of sources and of targets
  Multipoles multipoles_, of_targets_; ///< these for their lumpiness only
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
