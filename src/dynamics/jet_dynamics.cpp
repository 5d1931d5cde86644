#include "ehdjet/dynamics/jet_dynamics.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {

void JetDynamics::set_rheology(std::unique_ptr<Rheology> rheology) {
  rheology_ = rheology.get();
  terms_.push_back(std::move(rheology));
}

void JetDynamics::bind(const JetState& jet) {
  mass_ = jet.mass, volume_ = jet.volume, charge_ = jet.charge, landed_ = jet.landed;
  has_embryo_ = jet.has_embryo, absorbing_plane_ = jet.absorbing_plane;
  if (has_embryo_) embryo_charge_ = jet.charge[1];
  inverse_mass_.resize(mass_.size());
  std::ranges::transform(mass_, inverse_mass_.begin(), [](double m) { return 1 / m; });

  held_.clear();
  if (nozzle_ || ends_.first) held_.push_back(0);
  if (has_embryo_) held_.push_back(1);
  for (const LandedBead& b : landed_) held_.push_back(b.bead);
  frozen_ = held_;
  if (ends_.last) held_.push_back(jet.links()); // its link goes on like any other

  stage_.mass = mass_, stage_.charge = charge_, stage_.volume = volume_;
  stage_.first = jet.first(), stage_.landed = landed_;
}

void JetDynamics::prescribe(double t, std::span<double> y) const {
  if (!nozzle_) return;
  const JetColumns<double> jet{y, mass_.size()};
  const Vec3 nozzle = nozzle_->nozzle.position(t);
  jet.position().set(0, nozzle);
  jet.velocity().set(0, nozzle_->nozzle.velocity(t));
  if (has_embryo_)
    jet.position().set(1, nozzle_->embryo.position(nozzle, jet.position()[2]));
}

// Flying on with the velocity of their crossing is right to second order in the time since then,
// which is less than a step. All beads but the last one of those that have passed have left
// the chain: they act on nobody.
void JetDynamics::absorb(std::span<double> y) {
  passed_.clear();
  if (!absorbing_plane_) return;
  const JetColumns<double> jet{y, mass_.size()};
  const auto r = jet.position();
  const auto v = jet.velocity();
  const std::size_t first = stage_.first;
  auto landed = landed_.rbegin();
  bool any = false;
  for (std::size_t k = mass_.size(); k-- > first;) {
    const bool rests = landed != landed_.rend() && landed->bead == k;
    if (rests) ++landed;
    if (!rests && !(r.x[k] > *absorbing_plane_)) break;
    passed_.push_back({k, r[k], charge_[k]});
    if (rests) continue;
    any = true;
    const double late = v.x[k] > 0 ? (r.x[k] - *absorbing_plane_) / v.x[k] : 0.0;
    r.set(k, r[k] - late * v[k]);
  }
  if (!any) passed_.clear();
}

void JetDynamics::let_pass(std::span<double> y) {
  const auto r = JetColumns<double>{y, mass_.size()}.position();
  for (const Passed& p : passed_) r.set(p.bead, p.position), charge_[p.bead] = p.charge;
}

void JetDynamics::set_stage(double t, std::span<double> y) {
  prescribe(t, y);
  const JetColumns<double> jet{y, mass_.size()};
  stage_.time = t, stage_.columns = jet;
  stage_.invalidate();
  if (has_embryo_) {
    const double distance = (jet.position()[2] - jet.position()[0]).norm();
    charge_[1] = embryo_charge_ * nozzle_->embryo.charge_fraction(distance);
  }
}

void JetDynamics::evaluate(double t, std::span<double> y, std::span<double> rate) {
  EHDJET_EXPECTS(y.size() == rate.size() && !mass_.empty());
  ++evaluations_;
  absorb(y);
  for (std::size_t i = 0; i + 1 < passed_.size(); ++i) charge_[passed_[i].bead] = 0;
  set_stage(t, y);
  const std::size_t n = mass_.size();
  const JetColumns<double> rates{rate, n};

  const Vec3View force = rates.velocity(); // summed in place, then divided by the mass
  const std::span<double> forces = rate.subspan(3 * n, 3 * n);
  std::ranges::fill(forces, 0.0);
  for (const auto& term : terms_) term->add_force(stage_, force);
  if (rheology_) rheology_->stress_rate(stage_, rates.stress());
  let_pass(y);

  std::ranges::copy(y.subspan(3 * n, 3 * n), rate.begin()); // dr/dt = v
  const double* w = inverse_mass_.data();
  for (double* f : {force.x.data(), force.y.data(), force.z.data()}) {
#pragma omp simd
    for (std::size_t k = 0; k < n; ++k) f[k] *= w[k];
  }
  // How beads that have passed fly on is nobody's business any more: like the one before them, so
  // that the charges that vanish make no jump, which would only shorten the step.
  if (!passed_.empty() && passed_.back().bead > stage_.first)
    for (const Passed& p : passed_) force.set(p.bead, force[passed_.back().bead - 1]);
  for (const std::size_t k : held_)
    for (std::size_t c = 0; c < rates.kinematic_columns; ++c) rate[c * n + k] = 0;
  if (rheology_)
    for (const std::size_t k : frozen_) rates.stress()[k] = 0;
}

void JetDynamics::linearize(double t, std::span<const double> y) {
  stage_.time = t, stage_.columns = {y, mass_.size()};
  stage_.invalidate();
  linearized_at_ = t;
  jacobian_.reset(mass_.size(), stage_.first);
  for (const auto& term : terms_) term->add_derivatives(stage_, jacobian_.links());
  for (const std::size_t k : held_) jacobian_.hold(k);
  for (const std::size_t k : frozen_) jacobian_.freeze(k);
}

// The nozzle is the only bead that moves in a prescribed way and pulls at another one.
void JetDynamics::add_time_derivative(double factor, std::span<double> out) const {
  const std::size_t k = stage_.first;
  if (!nozzle_ || jacobian_.is_held(k)) return;
  Vec3 velocity = nozzle_->nozzle.velocity(linearized_at_);
  velocity.x() = 0; // the fluid flows through it, it stays
  const Vec3 acceleration = nozzle_->nozzle.acceleration(linearized_at_);
  const LinkDerivatives& links = jacobian_.links();
  const JetColumns<double> rates{out, mass_.size()};
  rates.velocity().add(k, factor * inverse_mass_[k] * (links.pull_lower[k] * velocity));
  if (rates.has_stress())
    rates.stress()[k] -=
        factor * (links.stretching[k].dot(acceleration) + links.turning[k].dot(velocity));
}

// Neighbours in opposite phase: s^2 + s/tau + omega^2 = 0 with elasticity, s^2 + omega^2 = 0
// without.
StiffPart::Modes JetDynamics::fastest_modes() const {
  const auto [elastic, tension] = jacobian_.squared_rates(inverse_mass_);
  double relaxation = 0;
  for (const double r : jacobian_.links().relaxation) relaxation = std::max(relaxation, r);
  Modes modes{-relaxation, 0, std::complex<double>(0, std::sqrt(tension))};
  if (const double decay = relaxation / 2, omega = std::sqrt(elastic); omega > decay)
    modes[1] = {-decay, std::sqrt((omega - decay) * (omega + decay))};
  return modes;
}

void JetDynamics::archive(const Archive& a) {
  a("evaluations", evaluations_);
  for (const auto& term : terms_) term->archive(a.part(term->name()));
}

std::uint64_t JetDynamics::coincident_pairs() const {
  std::uint64_t pairs = 0;
  for (const auto& term : terms_) pairs += term->coincident_pairs();
  return pairs;
}

std::optional<CoulombChecks> JetDynamics::coulomb_checks() const {
  for (const auto& term : terms_)
    if (const auto checks = term->checks()) return checks;
  return std::nullopt;
}

std::string JetDynamics::diagnosis(double t, std::span<const double> y, std::size_t bead) {
  const std::size_t n = mass_.size();
  for (std::size_t i = 0; i < y.size(); ++i)
    if (!std::isfinite(y[i]))
      return fmt::format("bead {}: its state is not a number", i % n);

  std::vector<double> state(y.begin(), y.end()), buffer(3 * n);
  const std::span<double> b(buffer);
  const Vec3View force{b.subspan(0, n), b.subspan(n, n), b.subspan(2 * n, n)};
  const auto moves = [&](std::size_t k) {
    return std::ranges::find(held_, k) == held_.end();
  };
  set_stage(t, state);
  std::string strongest = "no force";
  double largest = 0;
  for (const auto& term : terms_) {
    std::ranges::fill(buffer, 0.0);
    term->add_force(stage_, force);
    for (std::size_t k = 0; k < n; ++k)
      if (moves(k) && !force[k].allFinite())
        return fmt::format("bead {}: the force of {} is not a number", k, term->name());
    if (force[bead].norm() > largest) {
      largest = force[bead].norm();
      strongest = fmt::format("the strongest force there is {} ({:.3g} N, {:.3g} m/s^2)",
                              term->name(), largest, largest * inverse_mass_[bead]);
    }
  }
  if (rheology_) {
    const std::span<double> rate = b.subspan(0, n);
    rheology_->stress_rate(stage_, rate);
    for (std::size_t k = 0; k < n; ++k)
      if (moves(k) && !std::isfinite(rate[k]))
        return fmt::format("bead {}: the stress rate of {} is not a number", k,
                           rheology_->name());
  }
  return fmt::format("bead {}: {}", bead, strongest);
}

} // namespace ehdjet
