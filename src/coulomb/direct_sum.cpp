#include "ehdjet/coulomb/direct_sum.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "direct_sum_with.hpp"

namespace ehdjet {
namespace {

using detail::PairKernel;

/// Below this many beads starting the threads costs more than they save.
constexpr std::size_t parallel_from = 256;

/// Sources per sweep over the targets: seven columns of them stay in a first-level cache.
constexpr std::size_t block = 512;

struct alignas(64) CacheLine {
  double value[8];
};
static_assert(sizeof(CacheLine) / sizeof(double) == detail::padding);

/// p such that |v| 2^p < 2^exponent for all |v| <= largest, nearly attained; limited to where
/// 2^p is finite, beyond which all pairs are close or all charges tiny, and still right.
int scale_exponent(double largest, int exponent) {
  if (largest == 0) return 0;
  int e = 0;
  std::frexp(largest, &e);
  return std::min(exponent - e, 1000);
}

double largest_magnitude(std::span<const double> v) {
  double largest = 0;
  for (const double a : v) largest = std::max(largest, std::abs(a));
  return largest;
}

/// See `CoulombSolver` for the contract. The fast kernels work on scaled copies and skip close
/// pairs; those are rare and are added here from the original coordinates, which nothing can
/// overflow, or counted as coincident.
class DirectSum final : public CoulombSolver {
public:
  explicit DirectSum(PairKernel kernel)
      : kernel_(kernel) {}

  void add_force(ConstVec3View r, std::span<const double> q, Vec3View force) override {
    const std::size_t n = q.size();
    EHDJET_EXPECTS(r.x.size() == n && r.y.size() == n && r.z.size() == n);
    EHDJET_EXPECTS(force.x.size() == n && force.y.size() == n && force.z.size() == n);
    coincident_pairs_ = 0;
    if (n == 0) return;

    const int threads = n < parallel_from ? 1 : omp_get_max_threads();
    reserve(n, static_cast<std::size_t>(threads));
    load(r, q);
    if (threads == 1) {
      sum_fields(0, 1);
      add_forces(1, 0, n, force);
    } else {
#pragma omp parallel num_threads(threads)
      { // the runtime may grant fewer threads than asked for
        const auto team = static_cast<std::size_t>(omp_get_num_threads());
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        sum_fields(thread, team);
#pragma omp barrier
        add_forces(team, n * thread / team, n * (thread + 1) / team, force);
      }
    }
    add_close_pairs(r, q, force);
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
  void reserve(std::size_t n, std::size_t threads) {
    lines_ = (n + detail::padding - 1) / detail::padding;
    if (charges_.size() < 4 * lines_) charges_.resize(4 * lines_);
    if (fields_.size() < 3 * lines_ * threads) fields_.resize(3 * lines_ * threads);
    if (close_.size() < length()) close_.resize(length());
    std::fill(close_.begin(), close_.end(), static_cast<unsigned char>(0));
  }
  [[nodiscard]] std::size_t length() const {
    return lines_ * detail::padding;
  }

  [[nodiscard]] double* charge_column(std::size_t k) {
    return charges_[k * lines_].value;
  }
  [[nodiscard]] detail::ChargeColumns charges() {
    return {charge_column(0), charge_column(1), charge_column(2), charge_column(3)};
  }
  [[nodiscard]] detail::FieldColumns field(std::size_t thread) {
    CacheLine* first = fields_.data() + 3 * lines_ * thread;
    return {first->value, first[lines_].value, first[2 * lines_].value};
  }

  /// Powers of two change no digit: a difference of scaled coordinates is the scaled
  /// difference.
  void load(ConstVec3View r, std::span<const double> q) {
    const std::size_t n = q.size();
    const double extent =
        std::max({largest_magnitude(r.x), largest_magnitude(r.y), largest_magnitude(r.z)});
    const int p_r = scale_exponent(extent, detail::coordinate_exponent);
    const int p_q = scale_exponent(largest_magnitude(q), 0);
    const double scale[4] = {std::ldexp(1, p_r), std::ldexp(1, p_r), std::ldexp(1, p_r),
                             std::ldexp(1, p_q)};
    const std::span<const double> original[4] = {r.x, r.y, r.z, q};
    for (std::size_t k = 0; k < 4; ++k) {
      double* column = charge_column(k);
      for (std::size_t i = 0; i < n; ++i) column[i] = scale[k] * original[k][i];
      std::fill(column + n, column + length(), 0.0);
    }
    for (std::size_t i = n; i < length(); ++i)
      charge_column(0)[i] = detail::padding_distance * static_cast<double>(i - n + 1);
    // f = q q / r^2 is unscaled by 2^(2 p_r - 2 p_q); the whole of it may be out of range.
    root_unscale_ = std::ldexp(1, std::clamp(p_r - p_q, -1000, 1000));
  }

  /// The rows of this thread: every `team`-th, so that long and short rows are shared evenly.
  void sum_fields(std::size_t thread, std::size_t team) {
    const detail::FieldColumns g = field(thread);
    std::fill(g.x, g.x + 3 * length(), 0.0);
    for (std::size_t begin = 0; begin < length(); begin += block) {
      const std::size_t end = std::min(begin + block, length());
      kernel_.add_fields(charges(), g, {thread, team, begin, end}, close_.data());
    }
  }

  void add_forces(std::size_t team, std::size_t begin, std::size_t end, Vec3View force) {
    const double* q = charge_column(3);
    const std::span<double> out[3] = {force.x, force.y, force.z};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = begin; i < end; ++i) {
        double g = 0;
        for (std::size_t thread = 0; thread < team; ++thread)
          g += field(thread).x[k * length() + i];
        out[k][i] += constants::coulomb * q[i] * g * root_unscale_ * root_unscale_;
      }
    }
  }

  void add_close_pairs(ConstVec3View r, std::span<const double> q, Vec3View force) {
    const detail::ChargeColumns c = charges();
    const auto apart = [](const double* v, std::size_t i, std::size_t j) {
      return std::abs(v[i] - v[j]) >= detail::close_distance;
    };
    for (std::size_t row = 0; row * kernel_.targets < q.size(); ++row) {
      if (close_[row] == 0) continue;
      const std::size_t end = std::min((row + 1) * kernel_.targets, q.size());
      for (std::size_t i = row * kernel_.targets; i < end; ++i) {
        for (std::size_t j = i + 1; j < q.size(); ++j) {
          if (apart(c.x, i, j) || apart(c.y, i, j) || apart(c.z, i, j)) continue;
          add_close_pair(r, q, i, j, force);
        }
      }
    }
  }

  void add_close_pair(ConstVec3View r, std::span<const double> q, std::size_t i,
                      std::size_t j, Vec3View force) {
    const Vec3 d = r[i] - r[j];
    const double size = d.cwiseAbs().maxCoeff();
    if (size == 0) {
      ++coincident_pairs_;
      return;
    }
    if (q[i] == 0 || q[j] == 0) return; // 0 / size^2 could be 0 * inf below
    const Vec3 u = d / size;
    const Vec3 f = (constants::coulomb * (q[i] / size)) * (q[j] / size)
                   / (u.squaredNorm() * u.norm()) * u;
    force.add(i, f);
    force.add(j, -f);
  }

  PairKernel kernel_;
  std::size_t lines_ = 0; ///< cache lines per column
  double root_unscale_ = 1;
  std::size_t coincident_pairs_ = 0;
  std::vector<CacheLine> charges_;   ///< x, y, z, q
  std::vector<CacheLine> fields_;    ///< x, y, z of each thread
  std::vector<unsigned char> close_; ///< per tile of targets
};

} // namespace

std::unique_ptr<CoulombSolver> detail::make_direct_sum_with(PairKernel kernel) {
  return std::make_unique<DirectSum>(kernel);
}

SimdLevel best_simd_level() {
#if defined(__x86_64__)
  const bool fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
      && __builtin_cpu_supports("avx512vl"))
    return SimdLevel::avx512;
  if (fma) return SimdLevel::avx2;
#endif
  return SimdLevel::portable;
}

std::string_view name_of(SimdLevel level) {
  switch (level) {
  case SimdLevel::avx512:
    return "avx512";
  case SimdLevel::avx2:
    return "avx2";
  case SimdLevel::portable:
    break;
  }
  return "portable";
}

std::unique_ptr<CoulombSolver> make_direct_sum(SimdLevel level) {
  EHDJET_EXPECTS(level <= best_simd_level());
#if defined(__x86_64__)
  if (level == SimdLevel::avx512)
    return detail::make_direct_sum_with(detail::avx512_pair_kernel());
  if (level == SimdLevel::avx2)
    return detail::make_direct_sum_with(detail::avx2_pair_kernel());
#endif
  return detail::make_direct_sum_with(detail::portable_pair_kernel());
}

} // namespace ehdjet
