#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scaled_charges.hpp"
#include "solvers.hpp"

namespace ehdjet {
namespace {

using detail::PairKernel;

/// For fewer charges, starting the threads takes longer than they save.
constexpr std::size_t parallel_from = 256;

/// Sources per sweep over the targets. Their seven columns fit into the first-level cache.
constexpr std::size_t block = 512;

class DirectSum final : public CoulombSolver {
public:
  explicit DirectSum(PairKernel kernel)
      : kernel_(kernel) {}

  void add_force(const PointCharges& charges, Vec3View force) override {
    sum({&charges, 1}, charges.size(), force);
  }
  void add_force_from(const PointCharges& sources, const PointCharges& targets,
                      Vec3View force) override {
    const PointCharges groups[]{sources, targets};
    const double pairs =
        static_cast<double>(sources.size()) * static_cast<double>(targets.size());
    sum(groups, static_cast<std::size_t>(std::sqrt(pairs)), force);
  }
  [[nodiscard]] std::size_t coincident_pairs() const override { return coincident_pairs_; }
  [[nodiscard]] CoulombAccuracy accuracy() const override { return {.tolerance = 0}; }
  [[nodiscard]] std::string_view name() const override { return "direct"; }

private:
  void sum(std::span<const PointCharges> groups, std::size_t n, Vec3View force) {
    coincident_pairs_ = 0;
    if (detail::nothing_to_do(groups, force)) return;
    const int threads = n < parallel_from ? 1 : omp_get_max_threads();
    charges_.load(groups, static_cast<std::size_t>(threads));
    const std::size_t targets = groups.back().size();
    if (threads == 1) {
      sum_fields(0, 1, groups.size() == 1);
      charges_.add_forces(1, 0, targets, force);
    } else {
#pragma omp parallel num_threads(threads)
      { // the runtime may grant fewer threads than asked for
        const auto team = static_cast<std::size_t>(omp_get_num_threads());
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        sum_fields(thread, team, groups.size() == 1);
#pragma omp barrier
        charges_.add_forces(team, targets * thread / team, targets * (thread + 1) / team,
                            force);
      }
    }
    coincident_pairs_ = charges_.add_close_pairs(force);
  }

  /// Each thread takes every `team`-th row, so that long and short rows are shared evenly.
  void sum_fields(std::size_t thread, std::size_t team, bool mutual) {
    charges_.clear_field(thread);
    const auto &from = charges_.sources(), &to = charges_.targets();
    const auto add = mutual ? kernel_.add_fields : kernel_.add_fields_one_way;
    for (std::size_t begin = from.begin; begin < from.end; begin += block) {
      const std::size_t end = std::min(begin + block, from.end);
      add(charges_.columns(), charges_.field(thread),
          {to.begin / kernel_.targets + thread, to.end / kernel_.targets, team, begin, end},
          charges_.close());
    }
  }

  PairKernel kernel_;
  detail::ScaledCharges charges_;
  std::size_t coincident_pairs_ = 0;
};

} // namespace

double coulomb_energy(ConstVec3View r, std::span<const double> q) {
  EHDJET_EXPECTS(r.size() == q.size());
  const std::size_t n = q.size();
  std::vector<double> potential(n); // at each charge, of the charges before it, without k_C
#pragma omp parallel for schedule(dynamic, 64) if (n > 512)
  for (std::size_t i = 0; i < n; ++i) potential[i] = potential_sum(r[i], r, q, 0, i);
  CompensatedSum energy;
  for (std::size_t i = 0; i < n; ++i) energy += q[i] * potential[i];
  return constants::coulomb * energy;
}

std::unique_ptr<CoulombSolver> detail::make_direct_sum_with(PairKernel kernel) {
  return std::make_unique<DirectSum>(kernel);
}

std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level) {
  return detail::make_direct_sum_with(detail::kernels_of(level).pairs);
}

} // namespace ehdjet
