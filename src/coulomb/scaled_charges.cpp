#include "scaled_charges.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ehdjet::detail {
namespace {

/// The largest p with |v| 2^p < 2^exponent for all |v| <= largest, but at most 1000, so that 2^p is
/// finite. Results remain correct at this limit: all pairs are close, or all charges are tiny.
int scale_exponent(double largest, int exponent) {
  if (largest == 0) return 0;
  int e = 0;
  std::frexp(largest, &e);
  return std::min(exponent - e, 1000);
}

double largest_magnitude(std::span<const double> v) {
  std::array<double, most_parts> largest{};
  for_numbered_parts(0, v.size(),
                     [&](std::size_t part, std::size_t begin, std::size_t end) {
                       double most = 0;
#pragma omp simd reduction(max : most)
                       for (std::size_t i = begin; i < end; ++i)
                         most = std::max(most, std::abs(v[i]));
                       largest[part] = most;
                     });
  return *std::ranges::max_element(largest);
}

} // namespace

bool nothing_to_do(std::span<const PointCharges> groups, const Vec3View& force) {
  bool nothing = false;
  for (const PointCharges& c : groups) {
    const std::size_t n = c.size();
    EHDJET_EXPECTS(c.r.x.size() == n && c.r.y.size() == n && c.r.z.size() == n);
    EHDJET_EXPECTS(c.moves.empty() || c.moves.size() == n);
    EHDJET_EXPECTS(n < (std::size_t{1} << 30U));
    nothing = nothing || n == 0;
  }
  const std::size_t n = groups.back().size();
  EHDJET_EXPECTS(force.x.size() == n && force.y.size() == n && force.z.size() == n);
  return nothing;
}

void ScaledCharges::load(std::span<const PointCharges> groups, std::size_t threads,
                         bool with_moves) {
  number_ = groups.size();
  double extent = 0, charge = 0;
  std::size_t length = 0;
  any_rests_ = false;
  for (std::size_t g = 0; g < number_; ++g) {
    const PointCharges& c = groups[g];
    extent = std::max({extent, largest_magnitude(c.r.x), largest_magnitude(c.r.y),
                       largest_magnitude(c.r.z)});
    charge = std::max(charge, largest_magnitude(c.q));
    const std::size_t end = length + (c.size() + padding - 1) / padding * padding;
    groups_[g] = {c, length, end, {}};
    length = end;
    any_rests_ = any_rests_ || (with_moves && !c.moves.empty());
  }
  lines_ = length / padding;
  if (charges_.size() < 4 * lines_) charges_.resize(4 * lines_);
  if (fields_.size() < 3 * lines_ * threads) fields_.resize(3 * lines_ * threads);
  if (close_.size() < length) close_.resize(length);
  std::fill(close_.begin(), close_.end(), static_cast<unsigned char>(0));
  if (any_rests_ && moves_.size() < length) moves_.resize(length);

  const int p_r = scale_exponent(extent, coordinate_exponent);
  const int p_q = scale_exponent(charge, 0);
  scale_ = std::ldexp(1, p_r), charge_scale_ = std::ldexp(1, p_q);
  // The factor of f = q q / r^2 is 2^(2 p_r - 2 p_q). It may overflow, so its root is stored.
  root_unscale_ = std::ldexp(1, std::clamp(p_r - p_q, -1000, 1000));
  energy_exponent_ = p_r - 2 * p_q;
  std::size_t padded = 0; // each charge of the padding has its own place
  for (std::size_t g = 0; g < number_; ++g) {
    fill(groups_[g]);
    for (std::size_t i = groups_[g].begin + groups[g].size(); i < groups_[g].end; ++i) {
      column(0)[i] = padding_distance * static_cast<double>(++padded);
      column(1)[i] = column(2)[i] = column(3)[i] = 0;
    }
  }
}

void ScaledCharges::reorder(std::size_t group, std::span<const std::uint32_t> order) {
  groups_[group].order = order;
  fill(groups_[group]);
}

void ScaledCharges::fill(const Group& g) {
  const PointCharges& c = g.charges;
  const std::size_t n = c.size();
  const std::span<const double> original[4] = {c.r.x, c.r.y, c.r.z, c.q};
  for (std::size_t k = 0; k < 4; ++k) {
    double* out = column(k) + g.begin;
    const double *in = original[k].data(), s = k < 3 ? scale_ : charge_scale_;
    if (g.order.empty()) {
      for_parts(0, n, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
        for (std::size_t i = begin; i < end; ++i) out[i] = s * in[i];
      });
    } else {
      for_parts(0, n, [=, from = g.order.data()](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) out[i] = s * in[from[i]];
      });
    }
  }
  if (!any_rests_) return;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = g.order.empty() ? i : g.order[i];
    moves_[g.begin + i] = c.moves.empty() ? 1 : c.moves[from];
  }
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
  const Group& to = targets();
  const double* q = column(3) + to.begin;
  const std::span<double> out[3] = {force.x, force.y, force.z};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = begin; i < end; ++i) {
      double g = 0;
      for (std::size_t thread = 0; thread < team; ++thread)
        g += field(thread).x[k * length() + to.begin + i];
      out[k][to.order.empty() ? i : to.order[i]] +=
          constants::coulomb * q[i] * g * root_unscale_ * root_unscale_;
    }
  }
}

std::size_t ScaledCharges::add_close_pairs(Vec3View force, bool met_coincident) {
  if (!met_coincident && std::ranges::find(close_, 1) == close_.end()) return 0;
  const std::size_t pairs =
      close_pairs_.add_forces(sources().charges, targets().charges, scale_, force);
  // In one group each charge has met itself, and each pair has been counted twice.
  return number_ == 2 ? pairs : (pairs - sources().charges.size()) / 2;
}

} // namespace ehdjet::detail
