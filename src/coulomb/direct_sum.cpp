#include "ehdjet/coulomb/direct_sum.hpp"

#include "ehdjet/core/error.hpp"

#include <omp.h>

#include <algorithm>

#include "direct_sum_with.hpp"
#include "kernels.hpp"
#include "scaled_charges.hpp"

namespace ehdjet {
namespace {

using detail::PairKernel;

/// Below this many beads starting the threads costs more than they save.
constexpr std::size_t parallel_from = 256;

/// Sources per sweep over the targets: seven columns of them stay in a first-level cache.
constexpr std::size_t block = 512;

class DirectSum final : public CoulombSolver {
public:
  explicit DirectSum(PairKernel kernel)
      : kernel_(kernel)
      , charges_(kernel.targets) {}

  void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) override {
    const std::size_t n = q.size();
    EHDJET_EXPECTS(r.x.size() == n && r.y.size() == n && r.z.size() == n);
    EHDJET_EXPECTS(force.x.size() == n && force.y.size() == n && force.z.size() == n);
    coincident_pairs_ = 0;
    if (n == 0) return;

    const int threads = n < parallel_from ? 1 : omp_get_max_threads();
    charges_.reserve(n, static_cast<std::size_t>(threads));
    charges_.load(r, q);
    if (threads == 1) {
      sum_fields(0, 1);
      charges_.add_forces(1, 0, n, force);
    } else {
#pragma omp parallel num_threads(threads)
      { // the runtime may grant fewer threads than asked for
        const auto team = static_cast<std::size_t>(omp_get_num_threads());
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        sum_fields(thread, team);
#pragma omp barrier
        charges_.add_forces(team, n * thread / team, n * (thread + 1) / team, force);
      }
    }
    coincident_pairs_ = charges_.add_close_pairs(r, q, force);
  }

  [[nodiscard]] std::size_t coincident_pairs() const override {
    return coincident_pairs_;
  }
  [[nodiscard]] CoulombAccuracy accuracy() const override {
    return {.tolerance = 0};
  }
  [[nodiscard]] std::string_view name() const override {
    return "direct";
  }

private:
  /// The rows of this thread: every `team`-th, so that long and short rows are shared evenly.
  void sum_fields(std::size_t thread, std::size_t team) {
    charges_.clear_field(thread);
    const std::size_t length = charges_.length();
    for (std::size_t begin = 0; begin < length; begin += block) {
      const std::size_t end = std::min(begin + block, length);
      kernel_.add_fields(charges_.columns(), charges_.field(thread),
                         {thread, length, team, begin, end}, charges_.close());
    }
  }

  PairKernel kernel_;
  detail::ScaledCharges charges_;
  std::size_t coincident_pairs_ = 0;
};

} // namespace

std::unique_ptr<CoulombSolver> detail::make_direct_sum_with(PairKernel kernel) {
  return std::make_unique<DirectSum>(kernel);
}

std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level) {
  return detail::make_direct_sum_with(detail::kernels_of(level).pairs);
}

} // namespace ehdjet
