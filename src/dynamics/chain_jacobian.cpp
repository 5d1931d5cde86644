#include "ehdjet/dynamics/chain_jacobian.hpp"

#include "ehdjet/jet/jet_columns.hpp"

#include <algorithm>

namespace ehdjet {

void ChainJacobian::reset(std::size_t beads, std::size_t first) {
  links_.reset(beads);
  held_.assign(beads, 0);
  first_ = first;
}

void ChainJacobian::freeze(std::size_t link) {
  links_.stretching[link].setZero(), links_.turning[link].setZero();
  links_.relaxation[link] = 0;
}

void ChainJacobian::factorize(double eta, std::span<const double> mass) {
  const std::size_t n = held_.size();
  eta_ = eta, mass_ = mass;
  response_.resize(n), damping_.resize(n);
  lower_.resize(n), eliminated_.resize(n), pivot_.resize(n);
  const LinkDerivatives& l = links_;
  for (std::size_t k = 0; k < n; ++k) {
    damping_[k] = 1 / (1 + eta * l.relaxation[k]);
    response_[k] = (eta * damping_[k]) * (l.stretching[k] + eta * l.turning[k]);
  }
  const auto at_end = [&](const std::vector<Mat3>& pull, std::size_t k) -> Mat3 {
    Mat3 answer = eta * pull[k] + l.tension[k] * response_[k].transpose();
    if (!l.damping.empty()) answer += l.damping[k];
    return eta * answer;
  };
  // What bead k and everything above it weighs upon link k + 1. Written as a product: the
  // difference of two stiffnesses would lose the masses that it is about.
  Mat3 weight = Mat3::Zero();
  for (std::size_t k = 0; k < n; ++k) {
    lower_[k].setZero();
    const bool held = held_[k] != 0;
    if (k >= first_ && !held) {
      lower_[k] = at_end(l.pull_lower, k);
      weight = lower_[k] * pivot_[k - 1].solve(weight);
    } else {
      weight.setZero();
    }
    weight.diagonal().array() += mass[k];
    if (!l.drag.empty() && !held) weight += eta * l.drag[k];
    if (held || k + 1 == n) {
      pivot_[k].compute(weight);
      eliminated_[k].setZero();
      continue;
    }
    const Mat3 link = at_end(l.pull_upper, k + 1);
    pivot_[k].compute(weight + link);
    eliminated_[k] = pivot_[k].solve(link);
  }
}

void ChainJacobian::solve(std::span<double> x) const {
  const std::size_t n = held_.size();
  const JetColumns<double> columns{x, n};
  const Vec3View r = columns.position(), v = columns.velocity();
  const LinkDerivatives& l = links_;
  const std::span<double> stress = l.sigma ? columns.column(*l.sigma) : std::span<double>{};

  // Forward: right-hand sides and elimination. What link k does to its two ends is met at k - 1
  // and at k.
  Vec3 on_lower = Vec3::Zero(), on_upper = Vec3::Zero(), above = Vec3::Zero();
  const auto pass_link = [&](std::size_t k) {
    const Vec3 d = r[k] - r[upstream(k)];
    Vec3 drawn = Vec3::Zero();
    if (!stress.empty()) {
      stress[k] = damping_[k] * (stress[k] + eta_ * l.turning[k].dot(d));
      drawn = stress[k] * l.tension[k];
    }
    on_upper = l.pull_upper[k] * d + drawn, on_lower = l.pull_lower[k] * d + drawn;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 from_above = on_lower; // link k, upon its lower end
    on_upper.setZero(), on_lower.setZero();
    if (k + 1 < n && k + 1 >= first_) pass_link(k + 1);
    Vec3 right = mass_[k] * v[k];
    if (held_[k] == 0) right += eta_ * (on_upper - from_above) + lower_[k] * above;
    above = pivot_[k].solve(right);
    v.set(k, above);
  }
  for (std::size_t k = n - 1; k-- > 0;) v.add(k, eliminated_[k] * v[k + 1]);

  if (!stress.empty())
    for (std::size_t k = first_; k < n; ++k)
      stress[k] += response_[k].dot(v[k] - v[upstream(k)]);
  for (std::size_t c = 0; c < 3; ++c) {
    double *position = x.data() + c * n, *velocity = position + 3 * n;
#pragma omp simd
    for (std::size_t k = 0; k < n; ++k) position[k] += eta_ * velocity[k];
  }
}

ChainJacobian::Rates
ChainJacobian::squared_rates(std::span<const double> inverse_mass) const {
  Rates rates;
  const LinkDerivatives& l = links_;
  const std::size_t n = held_.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (held_[k] != 0) continue;
    double elastic = l.tension[k].dot(l.stretching[k]), pull = l.pull_lower[k].norm();
    if (k + 1 < n) {
      elastic += l.tension[k + 1].dot(l.stretching[k + 1]);
      pull += l.pull_upper[k + 1].norm();
    }
    rates.elastic = std::max(rates.elastic, 2 * inverse_mass[k] * elastic);
    rates.tension = std::max(rates.tension, 2 * inverse_mass[k] * pull);
  }
  return rates;
}

double ChainJacobian::damping_rate(std::span<const double> inverse_mass) const {
  const LinkDerivatives& l = links_;
  double fastest = 0;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    if (held_[k] != 0) continue;
    double rate = l.drag.empty() ? 0 : l.drag[k].norm();
    if (!l.damping.empty()) {
      rate += 2 * l.damping[k].norm();
      if (k + 1 < held_.size()) rate += 2 * l.damping[k + 1].norm();
    }
    fastest = std::max(fastest, inverse_mass[k] * rate);
  }
  return fastest;
}

} // namespace ehdjet
