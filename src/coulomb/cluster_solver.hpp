#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/coulomb/solver_options.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cluster_tree.hpp"
#include "expansion_tables.hpp"
#include "kernels.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// How a solver keeps its tolerance.
struct ClusterParameters {
  double tolerance = 1e-6;
  ToleranceNorm norm = ToleranceNorm::global;
  int order = 8;
  std::size_t leaf = 32; ///< a multiple of `padding`
  /// Radius over distance to the nearest point of the other ball: never more than this.
  double opening = 0.75;
};

/// What treecode and fast multipole method share: the cluster tree, the multipoles of its
/// clusters, and the scale that tells which error of a force is small.
///
/// A pair of clusters is accepted if the error of its expansions, estimated from the tails of the
/// series, is below the tolerance times the root mean square of the net force ("global") or times
/// the forces of the pair itself ("per_bead"). On a smooth curve forces cancel (their sum of
/// magnitudes is 10 to 1000 times the net force), which a criterion of angles alone would not see.
/// The root mean square is estimated anew in each call, on sampled charges: a call depends on its
/// arguments only.
class ClusterSolver : public CoulombSolver {
public:
  ClusterSolver(const Kernels& kernels, const ClusterParameters& parameters);
  ~ClusterSolver() override;
  ClusterSolver(const ClusterSolver&) = delete;
  ClusterSolver& operator=(const ClusterSolver&) = delete;

  void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) final;
  [[nodiscard]] double energy(ConstVec3View r, std::span<const double> q) final;
  [[nodiscard]] std::size_t coincident_pairs() const final { return coincident_pairs_; }
  [[nodiscard]] CoulombAccuracy accuracy() const final {
    return {.tolerance = parameters_.tolerance, .norm = parameters_.norm};
  }

  [[nodiscard]] std::string description() const final;
  void tighten() final { strictness_ /= 2; }
  void archive(const Archive& a) final { a("strictness", strictness_); }

protected:
  /// Allocates what further arrays the present tree needs.
  virtual void reserve(std::size_t threads) = 0;
  /// Decides which clusters act how; multipoles are known. Every thread of the team.
  virtual void plan(std::size_t thread, std::size_t team) = 0;
  /// Fields of all charges, into `charges_.field(...)`; every thread of the team.
  virtual void act(std::size_t thread, std::size_t team) = 0;

  /// Whether the tails of a pair's series are small enough; `both`: of multipoles and local
  /// expansions, or of the multipole of `source` only.
  [[nodiscard]] bool accepted(const Cluster& source, const Cluster& target,
                              bool mutual) const;
  [[nodiscard]] double* multipole(std::size_t cluster) {
    return multipoles_.data() + set_ * cluster;
  }

  /// Moves the expansions of the clusters of one level to their parents (upward), where they
  /// replace what was there, or adds those of the parents to theirs. Every thread of the team;
  /// `level` is the parents', `expansions` has one coefficient set per cluster.
  enum class Shift { upward, downward };
  void shift_level(std::size_t level, double* expansions, Shift direction);

  struct Displacement {
    double x, y, z;
    [[nodiscard]] double norm() const { return std::sqrt(x * x + y * y + z * z); }
  };
  [[nodiscard]] static Displacement between(const double* from, const double* to) {
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  }
  /// A batch whose lanes do nothing, and one lane of it put to use.
  [[nodiscard]] static ExpansionKernel::Batch idle_batch();
  static void set_lane(ExpansionKernel::Batch& batch, std::size_t lane, const double* from,
                       double* to, const Displacement& d);

  PairKernel pairs_;
  ExpansionKernel kernel_;
  ClusterParameters parameters_;
  ExpansionTables tables_;
  ExpansionNumbers numbers_;
  std::size_t set_; ///< numbers per coefficient set
  ScaledCharges charges_;
  ClusterTree tree_;

private:
  void compute(ConstVec3View r, std::span<const double> q, Vec3View force);
  [[nodiscard]] bool is_ordered() const;
  void sort(ConstVec3View r, std::span<const double> q);
  void gather_multipoles();
  void sample_forces();
  [[nodiscard]] double energy_of(std::uint32_t leaf, std::uint32_t source);
  [[nodiscard]] double force_scale();
  void sample_field(std::uint32_t cluster, std::size_t begin);

  ExpansionTables scale_tables_;
  ExpansionNumbers scale_numbers_;
  bool sorted_now_ = false; ///< the present charges were in no order along a curve
  double strictness_ = 1;   ///< halved at each violation
  double allowed_ = 0;      ///< error of a force by one pair of clusters
  std::size_t coincident_pairs_ = 0;
  std::vector<double> multipoles_;
  std::vector<double> squares_;        ///< of sampled forces, without k_C
  std::vector<double> energies_;       ///< of the leaves' charges in the field of all
  std::vector<unsigned char> ignored_; ///< flags of close pairs among samples

  struct Sorted; ///< a copy in another order, for charges that do not follow a curve
  std::unique_ptr<Sorted> sorted_;
};

std::unique_ptr<CoulombSolver> make_fast_multipole(const Kernels& kernels,
                                                   const ClusterParameters& parameters);
std::unique_ptr<CoulombSolver> make_treecode(const Kernels& kernels,
                                             const ClusterParameters& parameters);

} // namespace ehdjet::detail
