#include "ehdjet/refinement/akima_spline.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/gsl_errors.hpp"

#include <gsl/gsl_interp.h>

#include <algorithm>
#include <new>

namespace ehdjet {
namespace {

constexpr std::size_t least_knots = 5;

} // namespace

struct AkimaSpline::Gsl {
  explicit Gsl(std::size_t knots)
      : spline(gsl_interp_alloc(gsl_interp_akima, knots)) {}
  ~Gsl() { gsl_interp_free(spline); }
  Gsl(const Gsl&) = delete;
  Gsl& operator=(const Gsl&) = delete;
  gsl_interp* spline;
  gsl_interp_accel near{}; // the interval of the last look-up
};

AkimaSpline::AkimaSpline(std::span<const double> knots)
    : knots_(knots.begin(), knots.end())
    , given_(knots.size()) {
  EHDJET_EXPECTS(knots.size() >= 2);
  EHDJET_EXPECTS(std::ranges::adjacent_find(knots, std::ranges::greater_equal{})
                 == knots.end());
  while (knots_.size() < least_knots)
    knots_.push_back(knots_.back() + (knots_.back() - knots_.front()));
  values_.resize(knots_.size());
  const GslErrors as_status_codes;
  gsl_ = std::make_unique<Gsl>(knots_.size());
  if (gsl_->spline == nullptr) throw std::bad_alloc();
}

AkimaSpline::~AkimaSpline() = default;

void AkimaSpline::interpolate(std::span<const double> values, std::span<const double> at,
                              std::span<double> out) {
  EHDJET_EXPECTS(values.size() == given_ && at.size() == out.size());
  std::ranges::copy(values, values_.begin());
  const auto slope = [this](std::size_t i) { // of the interval that ends at knot i
    return (values_[i] - values_[i - 1]) / (knots_[i] - knots_[i - 1]);
  };
  for (std::size_t i = given_; i < knots_.size(); ++i) {
    const double continued = i > 2 ? 2 * slope(i - 1) - slope(i - 2) : slope(1);
    values_[i] = values_[i - 1] + continued * (knots_[i] - knots_[i - 1]);
  }
  const GslErrors as_status_codes;
  const char* failure = "the spline along the jet could not be evaluated";
  GslErrors::check(
      gsl_interp_init(gsl_->spline, knots_.data(), values_.data(), knots_.size()), failure);
  gsl_interp_accel_reset(&gsl_->near);
  for (std::size_t i = 0; i < at.size(); ++i)
    GslErrors::check(gsl_interp_eval_e(gsl_->spline, knots_.data(), values_.data(), at[i],
                                       &gsl_->near, &out[i]),
                     failure);
}

} // namespace ehdjet
