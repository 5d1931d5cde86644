#include "ehdjet/dynamics/jet_dynamics.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {

void JetDynamics::set_inflow(std::shared_ptr<const Inflow> inflow) {
  inflow_ = std::move(inflow);
  feeds_ = inflow_ && inflow_->feed();
  Constraints c = constraints();
  c.inflow = inflow_.get();
  chain_.constrain(c);
}

void JetDynamics::hold(HeldEnds ends) {
  Constraints c = constraints();
  c.ends = ends;
  chain_.constrain(c);
}

void JetDynamics::ground_collector() {
  Constraints c = constraints();
  c.grounded_collector = true;
  chain_.constrain(c);
}

void JetDynamics::insulate_collector() {
  Constraints c = constraints();
  c.insulating_collector = true;
  chain_.constrain(c);
}

void JetDynamics::move_collector(const Vec3& velocity) {
  Constraints c = constraints();
  c.plate_velocity = velocity;
  chain_.constrain(c);
}

void JetDynamics::lead(const LedParts& led) {
  Constraints c = constraints();
  c.led = led;
  chain_.constrain(c);
}

void JetDynamics::bind(const JetState& jet) {
  if (jet.table != table_) bind_columns(jet.table);
  chain_.bind(jet, jet.absorbing_plane);
  const LedParts& led = constraints().led;
  if (led.head > 0 || led.tail > 0) {
    EHDJET_EXPECTS(led.head + led.tail <= jet.beads());
    targets_ = {led.head, jet.beads() - led.tail}, sources_ = {led.head, jet.beads()};
  }
  resting_.clear();
  for (std::size_t c = 0; c < table_->integrated().size(); ++c) {
    const bool of_links = table_->integrated()[c].owner == Owner::link;
    if (of_links) resting_.push_back(c * jet.beads()); // bead 0 owns none
    for (const std::size_t k : of_links ? chain_.frozen() : chain_.held())
      resting_.push_back(c * jet.beads() + k);
  }
  carried_.clear();
  if (constraints().plate_velocity != Vec3::Zero())
    for (const LandedBead& b : jet.landed) carried_.push_back(b.bead);
}

void JetDynamics::bind_columns(std::shared_ptr<const BeadTable> table) {
  table_ = std::move(table), with_columns_.clear();
  std::size_t added = BeadTable::basic_integrated;
  for (const auto& term : terms_) {
    const auto columns = term->columns();
    const auto count = static_cast<std::size_t>(
        std::ranges::count(columns, Evolution::integrated, &BeadColumn::evolution));
    for (const BeadColumn& c : columns)
      EHDJET_EXPECTS(table_->find_integrated(c.name) || table_->find_carried(c.name));
    if (count > 0) with_columns_.push_back(term.get());
    added += count;
    term->bind(*table_);
  }
  EHDJET_EXPECTS(added == table_->integrated().size()); // each column has somebody's rate
}

void JetDynamics::prescribe(double t, std::span<double> y) const {
  if (inflow_) inflow_->prescribe(t, chain_.has_led_bead(), {y, chain_.beads()});
  if (const Guide* guide = constraints().led.guide)
    guide->prescribe(t, {y, chain_.beads()});
}

std::size_t JetDynamics::judged_rows(std::span<const double> end) const {
  constexpr std::size_t kinked = 4; // beads above one that passes
  const std::size_t n = chain_.beads();
  if (!constraints().led.passed_fly_on || !chain_.absorbing_plane()) return n;
  const auto x = end.first(n);
  const auto passed = std::ranges::find_if(
      x, [plane = *chain_.absorbing_plane()](double place) { return place > plane; });
  if (passed == x.end()) return n;
  const auto first = static_cast<std::size_t>(passed - x.begin());
  return first < kinked ? 0 : first - kinked;
}

void JetDynamics::evaluate(double t, std::span<const double> y, std::span<double> rate,
                           BeadRange targets, BeadRange sources) {
  EHDJET_EXPECTS(y.size() == rate.size() && chain_.beads() > 0);
  if (targets == targets_) ++evaluations_; // partial ones do not count
  const Stage& stage = chain_.at(t, y, targets, sources);
  const std::size_t begin = stage.targets.begin, end = stage.targets.end;
  const std::size_t n = chain_.beads();
  const JetColumns<double> rates{rate, n};
  const Vec3View force = rates.velocity(); // summed in place, then divided by the mass
  double *fx = force.x.data(), *fy = force.y.data(), *fz = force.z.data();
  for_parts(begin, end, [=](std::size_t from, std::size_t to) {
    for (double* f : {fx, fy, fz}) std::fill(f + from, f + to, 0.0);
  });
  for (const auto& term : terms_) term->add_force(stage, force);
  for (ForceTerm* term : with_columns_) term->set_column_rates(stage, rates);
  if (constraints().led.passed_fly_on && chain_.flying_on() < end) let_fly_on(force);

  const double* w = chain_.inverse_mass().data();
  for_parts(begin, end, [=](std::size_t from, std::size_t to) {
    for (std::size_t c = 0; c < 3; ++c) { // dr/dt = v
      const double* velocity = y.data() + (c + 3) * n;
      std::copy(velocity + from, velocity + to, rate.data() + c * n + from);
    }
    for (double* f : {fx, fy, fz}) {
#pragma omp simd
      for (std::size_t k = from; k < to; ++k) f[k] *= w[k];
    }
  });
  // How beads that have passed fly on does not matter any more: they do so like the one before
  // them, because a jump of their own acceleration would only shorten the step.
  const auto absorbed = chain_.absorbed();
  if (!absorbed.empty() && !constraints().led.passed_fly_on
      && absorbed.back() > stage.first)
    for (const std::size_t k : absorbed) force.set(k, force[absorbed.back() - 1]);
  for (const std::size_t i : resting_) rate[i] = 0;
  for (const std::size_t k : carried_)
    rates.position().set(k, constraints().plate_velocity);
}

void JetDynamics::let_fly_on(Vec3View force) {
  const Stage& stage = chain_.at_flying_on();
  const std::size_t n = chain_.beads();
  own_force_.assign(3 * n, 0.0); // a term may also write to beads that are no targets
  const std::span<double> all(own_force_);
  const Vec3View own{all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)};
  for (const auto& term : terms_) term->add_force(stage, own);
  for (std::size_t k = stage.targets.begin; k < stage.targets.end; ++k)
    force.set(k, own[k]);
}

void JetDynamics::linearize(double t, std::span<const double> y) {
  const Stage& stage = chain_.at(t, y, targets_, sources_);
  linearized_at_ = t;
  linearized_mass_.assign(chain_.mass().begin(), chain_.mass().end());
  jacobian_.reset(chain_.beads(), stage.first);
  for (const auto& term : terms_) term->add_derivatives(stage, jacobian_.links());
  for (const std::size_t k : chain_.held()) jacobian_.hold(k);
  for (const std::size_t k : chain_.frozen()) jacobian_.freeze(k);
}

// The nozzle is the only bead that moves in a prescribed way and pulls at another one.
void JetDynamics::add_time_derivative(double factor, std::span<double> out) const {
  const std::size_t k = chain_.stage().first;
  if (!inflow_ || jacobian_.is_held(k)) return;
  Vec3 velocity = inflow_->nozzle().velocity(linearized_at_);
  velocity.x() = 0; // the fluid flows through it, it stays
  const Vec3 acceleration = inflow_->nozzle().acceleration(linearized_at_);
  const LinkDerivatives& links = jacobian_.links();
  const JetColumns<double> rates{out, chain_.beads()};
  const double scale = factor * (1 / linearized_mass_[k]);
  rates.velocity().add(k, scale * (links.pull_lower[k] * velocity));
  if (!links.damping.empty())
    rates.velocity().add(k, scale * (links.damping[k] * acceleration));
  for (const LinkDerivatives::Column& c : links.columns())
    rates.column(c.place)[k] -=
        factor * (c.stretching[k].dot(acceleration) + c.turning[k].dot(velocity));
}

// Neighbours in opposite phase: s^2 + s/tau + omega^2 = 0 with elasticity, s^2 + omega^2 = 0
// without.
StiffPart::Modes JetDynamics::fastest_modes() const {
  const auto [elastic, tension] = jacobian_.squared_rates(chain_.inverse_mass());
  const double relaxation =
      std::max(jacobian_.damping_rate(chain_.inverse_mass()), jacobian_.relaxation_rate());
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
  for (const auto& term : terms_)
    if (const auto report = term->report()) pairs += report->coincident_pairs;
  return pairs;
}

std::optional<TermReport::Checks> JetDynamics::checks() const {
  for (const auto& term : terms_)
    if (const auto report = term->report(); report && report->checks) return report->checks;
  return std::nullopt;
}

std::string JetDynamics::diagnosis(double t, std::span<const double> y, std::size_t bead) {
  const std::size_t n = chain_.beads();
  for (std::size_t i = 0; i < y.size(); ++i)
    if (!std::isfinite(y[i]))
      return fmt::format("bead {}: its state is not a number", i % n);

  std::vector<double> state(y.begin(), y.end()), buffer(3 * n);
  const std::span<double> b(buffer);
  const Vec3View force{b.subspan(0, n), b.subspan(n, n), b.subspan(2 * n, n)};
  const auto moves = [&](std::size_t k) {
    return std::ranges::find(chain_.held(), k) == chain_.held().end();
  };
  prescribe(t, state);
  const Stage& stage = chain_.at(t, state);
  std::string strongest = "no force";
  double largest = 0;
  for (const auto& term : terms_) {
    std::ranges::fill(buffer, 0.0);
    term->add_force(stage, force);
    for (std::size_t k = 0; k < n; ++k)
      if (moves(k) && !force[k].allFinite())
        return fmt::format("bead {}: the force of {} is not a number", k, term->name());
    if (force[bead].norm() > largest) {
      largest = force[bead].norm();
      strongest = fmt::format("the strongest force there is {} ({:.3g} N, {:.3g} m/s^2)",
                              term->name(), largest, largest * chain_.inverse_mass()[bead]);
    }
  }
  buffer.assign(y.size(), 0.0);
  for (ForceTerm* term : with_columns_) {
    term->set_column_rates(stage, {buffer, n});
    for (std::size_t i = 0; i < buffer.size(); ++i)
      if (moves(i % n) && !std::isfinite(buffer[i]))
        return fmt::format("bead {}: the {} rate of {} is not a number", i % n,
                           table_->integrated()[i / n].name, term->name());
  }
  return fmt::format("bead {}: {}", bead, strongest);
}

} // namespace ehdjet
