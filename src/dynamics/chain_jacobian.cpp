#include "ehdjet/dynamics/chain_jacobian.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ehdjet {

void ChainJacobian::reset(std::size_t beads, std::size_t first) {
  links_.reset(beads);
  held_.assign(beads, 0);
  first_ = first;
}

void ChainJacobian::freeze(std::size_t link) {
  for (LinkDerivatives::Column& c : links_.columns()) {
    c.stretching[link].setZero(), c.turning[link].setZero();
    c.relaxation[link] = 0;
    if (!c.coupling.empty()) c.coupling[link] = 0;
  }
}

void ChainJacobian::eliminate_columns(double eta) {
  const std::size_t n = held_.size();
  const auto columns = std::as_const(links_).columns();
  if (eliminations_.size() < columns.size()) eliminations_.resize(columns.size());
  const auto strained = [eta](const LinkDerivatives::Column& c, std::size_t k) -> Vec3 {
    return c.stretching[k] + eta * c.turning[k];
  };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Elimination& e = eliminations_[i];
    e.response.resize(n), e.damping.resize(n), e.partner.clear();
    if (columns[i].coupling.empty()) {
      for (std::size_t k = 0; k < n; ++k) {
        e.damping[k] = 1 / (1 + eta * columns[i].relaxation[k]);
        e.response[k] = (eta * e.damping[k]) * strained(columns[i], k);
      }
      continue;
    }
    const LinkDerivatives::Column &a = columns[i], &b = columns[i + 1];
    Elimination& other = eliminations_[++i];
    other.response.resize(n), other.damping.resize(n);
    e.partner.resize(n), other.partner.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const double aa = 1 + eta * a.relaxation[k], ab = eta * a.coupling[k],
                   ba = eta * b.coupling[k], bb = 1 + eta * b.relaxation[k];
      const double determinant = aa * bb - ab * ba;
      e.damping[k] = bb / determinant, e.partner[k] = -ab / determinant;
      other.damping[k] = aa / determinant, other.partner[k] = -ba / determinant;
      const Vec3 of_a = eta * strained(a, k), of_b = eta * strained(b, k);
      e.response[k] = e.damping[k] * of_a + e.partner[k] * of_b;
      other.response[k] = other.damping[k] * of_b + other.partner[k] * of_a;
    }
  }
}

void ChainJacobian::factorize(double eta, std::span<const double> mass) {
  const std::size_t n = held_.size();
  eta_ = eta, mass_ = mass;
  eliminate_columns(eta);
  lower_.resize(n), eliminated_.resize(n), pivot_.resize(n);
  const LinkDerivatives& l = links_;
  const auto columns = l.columns();
  const auto at_end = [&](const std::vector<Mat3>& pull, std::size_t k) -> Mat3 {
    Mat3 answer = eta * pull[k];
    for (std::size_t i = 0; i < columns.size(); ++i)
      answer += columns[i].tension[k] * eliminations_[i].response[k].transpose();
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

Vec3 ChainJacobian::eliminated_pull(std::size_t k, const Vec3& d,
                                    const JetColumns<double>& x) const {
  const auto columns = links_.columns();
  Vec3 pull = Vec3::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const LinkDerivatives::Column& c = columns[i];
    const Elimination& e = eliminations_[i];
    double& sigma = x.column(c.place)[k];
    const double right = sigma + eta_ * c.turning[k].dot(d);
    sigma = e.damping[k] * right;
    if (!c.coupling.empty()) {
      const LinkDerivatives::Column& partner = columns[i + 1];
      const Elimination& other = eliminations_[++i];
      double& its = x.column(partner.place)[k];
      const double its_right = its + eta_ * partner.turning[k].dot(d);
      sigma += e.partner[k] * its_right;
      its = other.damping[k] * its_right + other.partner[k] * right;
      pull += its * partner.tension[k];
    }
    pull += sigma * c.tension[k];
  }
  return pull;
}

void ChainJacobian::solve(std::span<double> x) const {
  const std::size_t n = held_.size();
  const JetColumns<double> columns{x, n};
  const Vec3View r = columns.position(), v = columns.velocity();
  const LinkDerivatives& l = links_;

  // Forward: right-hand sides and elimination. What link k does to its two ends is met at k - 1
  // and at k.
  Vec3 on_lower = Vec3::Zero(), on_upper = Vec3::Zero(), above = Vec3::Zero();
  const auto pass_link = [&](std::size_t k) {
    const Vec3 d = r[k] - r[upstream(k)];
    const Vec3 drawn = eliminated_pull(k, d, columns);
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

  const auto of_links = l.columns();
  for (std::size_t i = 0; i < of_links.size(); ++i) {
    const std::span<double> sigma = columns.column(of_links[i].place);
    for (std::size_t k = first_; k < n; ++k)
      sigma[k] += eliminations_[i].response[k].dot(v[k] - v[upstream(k)]);
  }
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
    double elastic = 0, pull = l.pull_lower[k].norm();
    for (const LinkDerivatives::Column& c : l.columns()) {
      elastic += c.tension[k].dot(c.stretching[k]);
      if (k + 1 < n) elastic += c.tension[k + 1].dot(c.stretching[k + 1]);
    }
    if (k + 1 < n) {
      pull += l.pull_upper[k + 1].norm();
    }
    rates.elastic = std::max(rates.elastic, 2 * inverse_mass[k] * elastic);
    rates.tension = std::max(rates.tension, 2 * inverse_mass[k] * pull);
  }
  return rates;
}

double ChainJacobian::relaxation_rate() const {
  double fastest = 0;
  for (const LinkDerivatives::Column& c : links_.columns())
    for (std::size_t k = 0; k < held_.size(); ++k)
      fastest = std::max(fastest, c.relaxation[k]
                                      + (c.coupling.empty() ? 0 : std::abs(c.coupling[k])));
  return fastest;
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
