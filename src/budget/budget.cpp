#include "ehdjet/budget/budget.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace ehdjet {
namespace {

/// Gauss-Legendre on [0, 1], exact for polynomials of degree 9: beyond the errors of dense output.
struct Node {
  double place, weight;
};
constexpr std::array<Node, 5> nodes{{{0.046910077030668004, 0.11846344252809454},
                                     {0.23076534494715845, 0.23931433524968324},
                                     {0.5, 0.28444444444444444},
                                     {0.76923465505284155, 0.23931433524968324},
                                     {0.95308992296933200, 0.11846344252809454}}};

Channel channel_of(const Event& event) {
  const std::string_view name = event.name();
  if (name == "landing") return Channel::landing;
  if (name == "refinement") return Channel::refinement;
  EHDJET_EXPECTS(name == "insertion" || name == "release");
  return Channel::insertion;
}

} // namespace

void Budget::Sum::add(const Flow& flow, double factor) {
  energy += factor * flow.energy;
  x += factor * flow.momentum.x();
  y += factor * flow.momentum.y();
  z += factor * flow.momentum.z();
}

Budget::Budget(BudgetTerms terms)
    : balance_(std::move(terms)) {
  start_ = JetEnergies{};
  list({}, [this](const char* name, const char* unit, const char* meaning, double) {
    columns_.push_back({name, unit, meaning});
  });
  start_.reset();
}

void Budget::begin_step(const DenseStep& step,
                        std::span<const std::unique_ptr<Event>> events) {
  if (!start_) start_ = balance_.energies(step.jet);
  step_ = &step, events_ = events, theta_ = 0;
  inner_.clear(), next_inner_ = 0;
  for (const auto& e : events) e->list_inner_times(inner_);
  std::ranges::sort(inner_);
  inner_.erase(std::unique(inner_.begin(), inner_.end()), inner_.end());
  seen_ = step.jet;
}

void Budget::end_step(double t, double theta) {
  advance(t, theta);
  step_ = nullptr;
}

void Budget::advance(double t, double theta) {
  for (; next_inner_ < inner_.size() && inner_[next_inner_] <= t; ++next_inner_) {
    const double landing = inner_[next_inner_];
    integrate(std::min((landing - step_->t0) / step_->h, theta));
    pass(landing);
  }
  integrate(theta);
}

void Budget::integrate(double theta) {
  const double begin = theta_, width = theta - theta_;
  if (!(width > 0)) return;
  for (const Node& node : nodes) {
    const double at = begin + node.place * width;
    look_into_step(at, step_->time(at), step_->time(at));
    // The link of a bead that has landed within the step pulls with the stress that the step
    // gives it, not with the one that is on record for it.
    const auto stress = seen_.columns().stress();
    if (!stress.empty() && !inner_.empty()) {
      for (const LandedBead& b : seen_.landed)
        if (!step_->jet.is_landed(b.bead)) stress[b.bead] = step_->stress(at, b.bead);
    }
    const Flows flows = balance_.flows(seen_);
    for (std::size_t c = 0; c < channels; ++c)
      sums_[c].add(flows.flow[c], node.weight * width * step_->h);
  }
  theta_ = theta;
}

/// A bead lands and the step goes on: the jet right before and right after, as the events see it.
void Budget::pass(double landing_time) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  look_into_step(theta_, landing_time, std::nextafter(landing_time, -infinity));
  before_ = seen_;
  look_into_step(theta_, landing_time, landing_time);
  sum(Channel::landing).add(balance_.jump(before_, seen_), 1);
}

/// The jet at time t with what has happened to it up to `past`.
void Budget::look_into_step(double theta, double t, double past) {
  if (!inner_.empty()) seen_ = step_->jet; // the last look may have removed beads
  seen_.time = t;
  step_->state(theta, seen_.y);
  balance_.prescribe(seen_);
  if (inner_.empty()) return;
  for (const auto& e : events_) e->anticipate(past, seen_);
}

void Budget::before_event(const Event& /*event*/, const JetState& jet) {
  before_ = jet;
}

void Budget::after_event(const Event& event, const JetState& jet) {
  sum(channel_of(event)).add(balance_.jump(before_, jet), 1);
}

void Budget::measure(const JetSnapshot& snapshot, std::span<double> row) {
  EHDJET_EXPECTS(row.size() == columns_.size());
  if (step_ != nullptr)
    advance(snapshot.time, std::clamp((snapshot.time - step_->t0) / step_->h, theta_, 1.0));
  JetState jet = snapshot.jet;
  jet.time = snapshot.time;
  jet.y.assign(snapshot.columns.flat.begin(), snapshot.columns.flat.end());
  const JetEnergies now = balance_.energies(jet);
  if (!start_) start_ = now;
  std::size_t i = 0;
  list(now, [&](const char*, const char*, const char*, double value) { row[i++] = value; });
}

/// All columns in their order, with the values that they have now.
template <class Add>
void Budget::list(const JetEnergies& now, const Add& add) const {
  const BudgetTerms& terms = balance_.terms();
  double size = 0, residual = now.total() - start_->total();
  const auto stored = [&](const char* name, const char* meaning, double value) {
    add(name, "J", meaning, value);
    size += std::abs(value);
  };
  const auto brought = [&](Channel c, const char* name, const char* meaning) {
    const double value = sum(c).energy, sign = c == Channel::dissipation ? -1 : 1;
    residual -= value;
    stored(name, meaning, sign * value);
  };
  stored("kinetic_energy", "of beads that move freely", now.kinetic);
  if (terms.coulomb)
    stored("coulomb_energy", "of all pairs of charges, as they act", now.coulomb);
  if (terms.field) stored("field_energy", "-sum q E x, charges as they act", now.field);
  if (terms.gravity) stored("gravity_energy", "-sum m g x", now.gravity);
  if (terms.fluid) stored("elastic_energy", "sum V sigma^2/(2 G)", now.elastic);
  if (terms.line_tension) stored("surface_energy", "sum 2 alpha sqrt(pi V l)", now.surface);
  if (terms.fluid)
    brought(Channel::dissipation, "dissipated_energy",
            "lost so far to viscosity, sum V sigma^2/mu over time");
  if (terms.surface_tension)
    brought(Channel::surface, "surface_work",
            "work so far of the paper's surface tension, which has no energy");
  if (terms.source)
    brought(Channel::nozzle, "nozzle_work",
            "work so far of moving the nozzle and of feeding its link");
  if (terms.first_held || terms.last_held)
    brought(Channel::held, "held_work", "work so far of the held ends");
  if (terms.source)
    brought(Channel::insertion, "insertion_energy",
            "brought in so far by embryos: charging, leading, release");
  if (terms.lands)
    brought(Channel::landing, "landing_energy",
            "brought in so far at the collector: beads stopped and removed, links of "
            "landed beads");
  if (terms.refines)
    brought(Channel::refinement, "refinement_energy", "brought in so far by refinements");
  add("energy_residual", "J", "energy that is unaccounted for", residual);
  add("energy_residual_relative", "1",
      "the same over the sum of the magnitudes of all energies and works",
      size > 0 ? residual / size : 0);

  size = now.momentum_size;
  Vec3 rest = now.momentum - start_->momentum;
  const auto three = [&](std::array<const char*, 3> names, const char* meaning,
                         const Vec3& value) {
    for (int i = 0; i < 3; ++i)
      add(names[static_cast<std::size_t>(i)], "kg m/s", meaning, value[i]);
  };
  const auto impulse = [&](Channel c, std::array<const char*, 3> names,
                           const char* meaning) {
    const Vec3 value = sum(c).momentum();
    rest -= value, size += value.norm();
    three(names, meaning, value);
  };
  three({"momentum_x", "momentum_y", "momentum_z"}, "sum m v of beads that move freely",
        now.momentum);
  const auto along_x = [&](Channel c, const char* name, const char* meaning) {
    const Vec3 value = sum(c).momentum();
    rest -= value, size += value.norm();
    add(name, "kg m/s", meaning, value.x());
  };
  if (terms.field) along_x(Channel::field, "field_impulse_x", "so far, of the field");
  if (terms.gravity) along_x(Channel::gravity, "gravity_impulse_x", "so far, of gravity");
  if (terms.surface_tension)
    impulse(Channel::surface,
            {"surface_impulse_x", "surface_impulse_y", "surface_impulse_z"},
            "so far, of the paper's surface tension");
  if (terms.source)
    impulse(Channel::nozzle, {"nozzle_impulse_x", "nozzle_impulse_y", "nozzle_impulse_z"},
            "so far, of the nozzle on the jet");
  if (terms.first_held || terms.last_held)
    impulse(Channel::held, {"held_impulse_x", "held_impulse_y", "held_impulse_z"},
            "so far, of the held ends on the chain");
  if (terms.source)
    impulse(Channel::insertion,
            {"insertion_momentum_x", "insertion_momentum_y", "insertion_momentum_z"},
            "brought in so far by embryos: their push, and at their release");
  if (terms.lands)
    impulse(Channel::landing,
            {"landing_momentum_x", "landing_momentum_y", "landing_momentum_z"},
            "brought in so far by beads that land, and by the pull of those that have");
  if (terms.refines)
    impulse(Channel::refinement,
            {"refinement_momentum_x", "refinement_momentum_y", "refinement_momentum_z"},
            "brought in so far by refinements");
  three({"momentum_residual_x", "momentum_residual_y", "momentum_residual_z"},
        "momentum that is unaccounted for", rest);
  add("momentum_residual_relative", "1",
      "its magnitude over sum m |v| and the magnitudes of all impulses",
      size > 0 ? rest.norm() / size : 0);
}

} // namespace ehdjet
