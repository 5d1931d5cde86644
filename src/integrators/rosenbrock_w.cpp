#include "ehdjet/integrators/rosenbrock_w.hpp"

#include "ehdjet/core/error.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <numeric>
#include <utility>

#include "weighted_sum.hpp"

namespace ehdjet {
namespace {

double sum_of(const std::vector<double>& row) {
  return std::accumulate(row.begin(), row.end(), 0.0);
}

// b_i(theta) of four stages from the linear conditions of order:
//     sum b = theta,  sum b alpha = theta^2/2,  sum b gamma = 0,  sum b alpha^2 = theta^3/3
std::vector<std::array<double, 3>> dense_weights(const std::vector<double>& alpha,
                                                 const std::vector<double>& gamma) {
  EHDJET_EXPECTS(alpha.size() == 4);
  Eigen::Matrix4d conditions;
  for (int i = 0; i < 4; ++i) {
    const double a = alpha[static_cast<std::size_t>(i)];
    conditions.col(i) << 1, a, gamma[static_cast<std::size_t>(i)], a * a;
  }
  Eigen::Matrix<double, 4, 3> powers = Eigen::Matrix<double, 4, 3>::Zero();
  powers(0, 0) = 1, powers(1, 1) = 1. / 2, powers(3, 2) = 1. / 3;
  const Eigen::Matrix<double, 4, 3> b = conditions.partialPivLu().solve(powers);
  std::vector<std::array<double, 3>> weights;
  weights.reserve(4);
  for (int i = 0; i < 4; ++i) weights.push_back({b(i, 0), b(i, 1), b(i, 2)});
  return weights;
}

} // namespace

RosenbrockW::RosenbrockW(const RosenbrockTableau& method, ErrorScale scale)
    : method_(&method)
    , scale_(std::move(scale))
    , k_(method.b.size()) {
  for (const auto& row : method.a) alpha_.push_back(sum_of(row));
  for (const auto& row : method.g) gamma_.push_back(method.gamma + sum_of(row));
  dense_ = dense_weights(alpha_, gamma_);
}

void RosenbrockW::resize(std::size_t n) {
  if (y1_.size() == n) return;
  for (auto& k : k_) k.resize(n);
  for (auto* v : {&start_rate_, &y1_}) v->resize(n);
  restart();
}

void RosenbrockW::prepare_start(OdeSystem& system, double t, std::span<const double> y) {
  if (start_known_) return;
  system.evaluate(t, y, start_rate_);
  system.stiff_part()->linearize(t, y);
  start_known_ = true;
}

// Solved for w = k_i + sum_j (g_ij/gamma) k_j, which needs no product with J:
//     (I - h gamma J) w = f_i + sum_j (g_ij/gamma) k_j + h gamma_i df/dt
StepOutcome RosenbrockW::attempt(OdeSystem& system, double t, double h,
                                 std::span<const double> y) {
  resize(y.size());
  y0_ = y, h_ = h;
  const std::size_t n = y.size();
  StiffPart* stiff = system.stiff_part();
  EHDJET_EXPECTS(stiff != nullptr);
  prepare_start(system, t, y);
  stiff->factorize(method_->gamma * h);
  for (std::size_t i = 0; i < k_.size(); ++i) {
    WeightedVectors place, rate, back;
    for (std::size_t j = 0; j < i; ++j) {
      place.add(k_[j].data(), h * method_->a[i][j]);
      rate.add(k_[j].data(), method_->g[i][j] / method_->gamma);
      back.add(k_[j].data(), -method_->g[i][j] / method_->gamma);
    }
    const double* f = start_rate_.data();
    if (place.count > 0) {
      combine(y.data(), place, y1_.data(), n);
      system.prescribe(t + alpha_[i] * h, y1_);
      system.evaluate(t + alpha_[i] * h, y1_, k_[i]);
      f = k_[i].data();
    }
    combine(f, rate, k_[i].data(), n);
    stiff->add_time_derivative(h * gamma_[i], k_[i]);
    stiff->solve(k_[i]);
    combine(k_[i].data(), back, k_[i].data(), n);
  }

  WeightedVectors end;
  for (std::size_t i = 0; i < k_.size(); ++i) end.add(k_[i].data(), h * method_->b[i]);
  combine(y.data(), end, y1_.data(), n);
  system.prescribe(t + h, y1_);
  judged_ = system.judged_rows(y1_);
  const WeightedVectors error = weighted_error();
  return {scale_.norm([&error](std::size_t first,
                               std::span<double> out) { combine_block(error, first, out); },
                      y0_, y1_, judged_)};
}

WeightedVectors RosenbrockW::weighted_error() const {
  WeightedVectors sum;
  for (std::size_t i = 0; i < k_.size(); ++i)
    sum.add(k_[i].data(), h_ * (method_->b[i] - method_->embedded[i]));
  return sum;
}

std::size_t RosenbrockW::worst_component() const {
  std::vector<double> error(y1_.size(), 0.0);
  combine(error.data(), weighted_error(), error.data(), error.size());
  return scale_.worst(error, y0_, y1_, judged_);
}

void RosenbrockW::dense_output(double theta, std::size_t first,
                               std::span<double> out) const {
  WeightedVectors sum;
  for (std::size_t i = 0; i < k_.size(); ++i) {
    const auto& [c1, c2, c3] = dense_[i];
    sum.add(k_[i].data() + first, h_ * theta * (c1 + theta * (c2 + theta * c3)));
  }
  combine(y0_.data() + first, sum, out.data(), out.size());
}

void RosenbrockW::commit(std::vector<double>& y) {
  y.swap(y1_);
  start_known_ = false;
}

double RosenbrockW::initial_step(OdeSystem& system, double t, std::span<const double> y) {
  resize(y.size());
  prepare_start(system, t, y);
  const double rate =
      scale_.norm(start_rate_, y, y) * scale_.rtol; // relative change per second
  return rate > 0 ? 0.01 / rate : 0;
}

} // namespace ehdjet
