#include "ehdjet/integrators/runge_kutta.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "weighted_sum.hpp"

namespace ehdjet {

namespace {

/// A stage to which nothing refers any more once all stages are known, or s if there is none. It can make
/// room for k_s.
std::size_t stage_done_with(const ButcherTableau& method) {
  const auto is_used = [](const std::vector<double>& row, std::size_t j) {
    return j < row.size() && row[j] != 0;
  };
  for (std::size_t j = 1; j < method.stages.size(); ++j) {
    bool used = is_used(method.b, j);
    for (const auto& row : method.error) used |= is_used(row, j);
    for (const auto& row : method.dense) used |= is_used(row, j);
    for (const auto& stage : method.extra) used |= is_used(stage.a, j);
    if (!used) return j;
  }
  return method.stages.size();
}

} // namespace

RungeKutta::RungeKutta(const ButcherTableau& method, ErrorScale scale)
    : method_(&method)
    , scale_(std::move(scale))
    , k_(method.stages.size() + 1 + method.extra.size())
    , end_(stage_done_with(method)) {
  EHDJET_EXPECTS(k_.size() <= WeightedVectors{}.vector.size());
  for (const auto& e : method.error) error_needs_end_ |= e.size() > method.stages.size();
}

void RungeKutta::resize(std::size_t n) {
  if (y1_.size() == n) return;
  for (std::size_t j = 0; j < k_.size(); ++j) k(j).resize(n);
  y1_.resize(n);
  if (!method_->extra.empty()) extra_stage_.resize(n);
  restart();
}

WeightedVectors RungeKutta::weighted(double factor, const std::vector<double>& row) const {
  WeightedVectors sum;
  for (std::size_t j = 0; j < row.size(); ++j) sum.add(k(j).data(), factor * row[j]);
  return sum;
}

void RungeKutta::evaluate_stage(OdeSystem& system, std::size_t j,
                                const ButcherTableau::Stage& stage,
                                std::vector<double>& place) {
  combine(y0_.data(), weighted(h_, stage.a), place.data(), place.size());
  system.prescribe(t_ + stage.c * h_, place);
  system.evaluate(t_ + stage.c * h_, place, k(j));
}

void RungeKutta::evaluate_end(OdeSystem& system) {
  if (end_known_) return;
  system.prescribe(t_ + h_, y1_);
  system.evaluate(t_ + h_, y1_, k(method_->stages.size()));
  end_known_ = true;
}

StepOutcome RungeKutta::attempt(OdeSystem& system, double t, double h,
                                std::span<const double> y) {
  resize(y.size());
  y0_ = y, t_ = t, h_ = h;
  end_known_ = extra_known_ = false;
  if (!first_known_) system.evaluate(t, y, k(0));
  first_known_ = true;
  const auto& stages = method_->stages;
  for (std::size_t i = 1; i < stages.size(); ++i) evaluate_stage(system, i, stages[i], y1_);

  combine(y0_.data(), weighted(h, method_->b), y1_.data(), y1_.size());
  if (method_->error_order == 0) return {.error = is_finite(y1_) ? 0.0 : std::nan("")};
  if (error_needs_end_) evaluate_end(system);
  judged_ = system.judged_rows(y1_);
  return {estimated_error()};
}

double RungeKutta::estimated_error() const {
  std::array<double, 2> norms{};
  for (std::size_t e = 0; e < method_->error.size(); ++e) {
    const WeightedVectors sum = weighted(h_, method_->error[e]);
    norms[e] =
        scale_.norm([&sum](std::size_t first,
                           std::span<double> out) { combine_block(sum, first, out); },
                    y0_, y1_, judged_);
  }
  if (method_->error.size() == 1 || norms[0] == 0) return norms[0];
  return norms[0] / std::hypot(1.0, 0.1 * norms[1] / norms[0]); // no square underflows
}

std::size_t RungeKutta::worst_component() const {
  if (method_->error_order == 0) return 0;
  std::vector<double> error(y1_.size(), 0.0);
  combine(error.data(), weighted(h_, method_->error[0]), error.data(), error.size());
  return scale_.worst(error, y0_, y1_, judged_);
}

void RungeKutta::prepare_dense_output(OdeSystem& system) {
  evaluate_end(system);
  if (extra_known_) return;
  for (std::size_t i = 0; i < method_->extra.size(); ++i)
    evaluate_stage(system, method_->stages.size() + 1 + i, method_->extra[i], extra_stage_);
  extra_known_ = true;
}

// With D = y1 - y0, x = theta, u = 1 - theta (Hairer, Norsett & Wanner, II.6 and II.10):
//
//     y(x) = y0 + x (D + u (F1 + x (F2 + u (F3 + x (F4 + u (F5 + x F6))))))
//     F1 = h k_0 - D,   F2 = 2 D - h (k_0 + k_s),   F_(3+r) = h sum_i dense[r][i] k_i
//
// The first line up to F2 is the cubic Hermite polynomial, which every method has.
void RungeKutta::dense_output(double theta, std::size_t first,
                              std::span<double> out) const {
  EHDJET_EXPECTS(end_known_ && (extra_known_ || method_->extra.empty()));
  const double x = theta, u = 1 - theta;
  const std::size_t end = method_->stages.size();
  std::array<double, 16> weight{};
  double factor = x * u * x; // of F2, then of F3, F4, ...
  weight[0] = h_ * (x * u - factor);
  weight[end] = -h_ * factor;
  const double difference = x - x * u + 2 * factor;
  for (std::size_t r = 0; r < method_->dense.size(); ++r) {
    factor *= r % 2 == 0 ? u : x;
    for (std::size_t i = 0; i < method_->dense[r].size(); ++i)
      weight[i] += h_ * factor * method_->dense[r][i];
  }
  WeightedVectors sum;
  for (std::size_t i = 0; i < k_.size(); ++i) sum.add(k(i).data() + first, weight[i]);
  const double *y0 = y0_.data() + first, *y1 = y1_.data() + first;
  double* y = out.data();
  for_parts(0, out.size(), [=](std::size_t begin, std::size_t end_of_part) {
    for (std::size_t i = begin; i < end_of_part; ++i)
      y[i] = y0[i] + difference * (y1[i] - y0[i]);
  });
  combine(out.data(), sum, out.data(), out.size());
}

std::span<const double> RungeKutta::end_rate() const {
  if (!end_known_) return {};
  return k(method_->stages.size());
}

void RungeKutta::start_from_rate(std::span<const double> rate) {
  resize(rate.size());
  std::ranges::copy(rate, k(0).begin());
  first_known_ = true;
}

void RungeKutta::archive(const Archive& a) {
  std::vector<double> rate;
  if (first_known_) rate = k(0);
  a("first_rate", rate);
  if (!a.is_reading()) return;
  restart();
  if (!rate.empty()) start_from_rate(rate);
}

void RungeKutta::commit(std::vector<double>& y) {
  y.swap(y1_);
  if (end_known_) k(0).swap(k(method_->stages.size()));
  // It is evaluated at t_ + h_, which may differ from the next t by round-off. Only a method that
  // always evaluates it may use it; otherwise a read inside the step would change the jet.
  first_known_ = end_known_ && error_needs_end_;
}

double RungeKutta::initial_step(OdeSystem& system, double t, std::span<const double> y) {
  resize(y.size());
  system.evaluate(t, y, k(0));
  first_known_ = true;
  const double rate = scale_.norm(k(0), y, y) * scale_.rtol; // relative change per second
  return rate > 0 ? 0.01 / rate : 0;
}

} // namespace ehdjet
