#include "scaled_charges.hpp"

#include "ehdjet/core/constants.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet::detail {
namespace {

/// p such that |v| 2^p < 2^exponent for all |v| <= largest, nearly attained; limited to where
/// 2^p is finite, beyond which all pairs are close or all charges tiny, and still right.
int scale_exponent(double largest, int exponent) {
  if (largest == 0) return 0;
  int e = 0;
  std::frexp(largest, &e);
  return std::min(exponent - e, 1000);
}

/// Fewer charges than this are copied in less time than it takes to wake up threads.
constexpr std::size_t parallel_from = 30'000;

double largest_magnitude(std::span<const double> v) {
  double largest = 0;
#pragma omp parallel for simd reduction(max : largest) if (v.size() >= parallel_from)
  for (std::size_t i = 0; i < v.size(); ++i) largest = std::max(largest, std::abs(v[i]));
  return largest;
}

// True if the pair was coincident.
bool add_close_pair(ConstVec3View r, std::span<const double> q, std::size_t i,
                    std::size_t j, Vec3View force) {
  const Vec3 d = r[i] - r[j];
  const double size = d.cwiseAbs().maxCoeff();
  if (size == 0) return true;
  if (q[i] == 0 || q[j] == 0) return false; // 0 / size^2 could be 0 * inf below
  const Vec3 u = d / size;
  const Vec3 f = (constants::coulomb * (q[i] / size)) * (q[j] / size)
                 / (u.squaredNorm() * u.norm()) * u;
  force.add(i, f);
  force.add(j, -f);
  return false;
}

} // namespace

void ScaledCharges::reserve(std::size_t n, std::size_t threads) {
  size_ = n;
  lines_ = (n + padding - 1) / padding;
  if (charges_.size() < 4 * lines_) charges_.resize(4 * lines_);
  if (fields_.size() < 3 * lines_ * threads) fields_.resize(3 * lines_ * threads);
  if (close_.size() < length()) close_.resize(length());
  std::fill(close_.begin(), close_.end(), static_cast<unsigned char>(0));
}

// A difference of scaled coordinates is the scaled difference.
void ScaledCharges::load(ConstVec3View r, std::span<const double> q) {
  const std::size_t n = q.size();
  const double extent =
      std::max({largest_magnitude(r.x), largest_magnitude(r.y), largest_magnitude(r.z)});
  const int p_r = scale_exponent(extent, coordinate_exponent);
  const int p_q = scale_exponent(largest_magnitude(q), 0);
  const double scale[4] = {std::ldexp(1, p_r), std::ldexp(1, p_r), std::ldexp(1, p_r),
                           std::ldexp(1, p_q)};
  const std::span<const double> original[4] = {r.x, r.y, r.z, q};
  for (std::size_t k = 0; k < 4; ++k) {
    double* out = column(k);
    const double *in = original[k].data(), s = scale[k];
#pragma omp parallel for simd schedule(static) if (n >= parallel_from)
    for (std::size_t i = 0; i < n; ++i) out[i] = s * in[i];
    std::fill(out + n, out + length(), 0.0);
  }
  for (std::size_t i = n; i < length(); ++i)
    column(0)[i] = padding_distance * static_cast<double>(i - n + 1);
  // f = q q / r^2 is unscaled by 2^(2 p_r - 2 p_q); the whole of it may be out of range.
  root_unscale_ = std::ldexp(1, std::clamp(p_r - p_q, -1000, 1000));
  energy_exponent_ = p_r - 2 * p_q;
}

double ScaledCharges::energy(double scaled) const {
  return std::ldexp(constants::coulomb * scaled, energy_exponent_);
}

FieldColumns ScaledCharges::field(std::size_t thread) {
  CacheLine* first = fields_.data() + 3 * lines_ * thread;
  return {first->value, first[lines_].value, first[2 * lines_].value};
}

void ScaledCharges::clear_field(std::size_t thread) {
  const FieldColumns g = field(thread);
  std::fill(g.x, g.x + 3 * length(), 0.0);
}

void ScaledCharges::add_forces(std::size_t team, std::size_t begin, std::size_t end,
                               Vec3View force) {
  const double* q = column(3);
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

std::size_t ScaledCharges::add_close_pairs(ConstVec3View r, std::span<const double> q,
                                           Vec3View force) {
  std::size_t coincident = 0;
  const ChargeColumns c = columns();
  const auto apart = [](const double* v, std::size_t i, std::size_t j) {
    return std::abs(v[i] - v[j]) >= close_distance;
  };
  for (std::size_t row = 0; row * tile_ < q.size(); ++row) {
    if (close_[row] == 0) continue;
    const std::size_t end = std::min((row + 1) * tile_, q.size());
    for (std::size_t i = row * tile_; i < end; ++i) {
      for (std::size_t j = i + 1; j < q.size(); ++j) {
        if (apart(c.x, i, j) || apart(c.y, i, j) || apart(c.z, i, j)) continue;
        if (add_close_pair(r, q, i, j, force)) ++coincident;
      }
    }
  }
  return coincident;
}

} // namespace ehdjet::detail
