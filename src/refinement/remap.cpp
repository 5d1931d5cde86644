#include "ehdjet/refinement/remap.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/gsl_errors.hpp"

#include <gsl/gsl_interp.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

namespace ehdjet {
namespace {

struct FreeInterpolation {
  void operator()(gsl_interp* p) const { gsl_interp_free(p); }
};

} // namespace

Remap::Remap(std::vector<double> from, std::vector<double> to, Spread spread)
    : from_(std::move(from))
    , to_(std::move(to)) {
  EHDJET_EXPECTS(from_.size() >= 2 && to_.size() >= 2);
  EHDJET_EXPECTS(from_.front() == to_.front() && from_.back() == to_.back());
  constexpr std::size_t least_knots_of_a_cubic = 3;
  if (spread == Spread::linear || from_.size() < least_knots_of_a_cubic) find_overlaps();
}

std::vector<double> Remap::operator()(std::span<const double> quantity) const {
  EHDJET_EXPECTS(quantity.size() + 1 == from_.size());
  return overlaps_.empty() ? smoothly(quantity) : evenly(quantity);
}

void Remap::find_overlaps() {
  overlaps_.reserve(from_.size() + to_.size());
  for (std::size_t i = 0, j = 0; i + 1 < from_.size() && j + 1 < to_.size();) {
    const double start = std::max(from_[i], to_[j]);
    const double end = std::min(from_[i + 1], to_[j + 1]);
    if (end > start) overlaps_.push_back({i, j, (end - start) / (from_[i + 1] - from_[i])});
    (from_[i + 1] < to_[j + 1] ? i : j) += 1;
  }
}

// Overlap by overlap rather than as a difference of cumulative sums: a small link keeps its digits.
std::vector<double> Remap::evenly(std::span<const double> quantity) const {
  std::vector<double> moved(to_.size() - 1, 0.0);
  for (const Overlap& o : overlaps_) moved[o.to] += quantity[o.from] * o.share;
  return moved;
}

std::vector<double> Remap::smoothly(std::span<const double> quantity) const {
  std::vector<double> cumulative(from_.size(), 0.0);
  for (std::size_t i = 0; i < quantity.size(); ++i)
    cumulative[i + 1] = cumulative[i] + quantity[i];
  const GslErrors as_status_codes;
  const char* failure = "the cumulative curve along the jet could not be evaluated";
  const std::unique_ptr<gsl_interp, FreeInterpolation> curve(
      gsl_interp_alloc(gsl_interp_steffen, from_.size()));
  if (!curve) throw std::bad_alloc();
  GslErrors::check(
      gsl_interp_init(curve.get(), from_.data(), cumulative.data(), from_.size()), failure);
  gsl_interp_accel near{};
  const auto at = [&](double s) {
    double value = 0;
    GslErrors::check(
        gsl_interp_eval_e(curve.get(), from_.data(), cumulative.data(), s, &near, &value),
        failure);
    return value;
  };
  std::vector<double> moved(to_.size() - 1);
  double before = 0;
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const double after = j + 1 < moved.size() ? at(to_[j + 1]) : cumulative.back();
    moved[j] = after - before;
    before = after;
  }
  return moved;
}

} // namespace ehdjet
