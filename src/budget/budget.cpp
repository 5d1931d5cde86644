#include "ehdjet/budget/budget.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
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

} // namespace

void Budget::Sum::add(const Flow& flow, double factor) {
  energy += factor * flow.energy;
  x += factor * flow.momentum.x();
  y += factor * flow.momentum.y();
  z += factor * flow.momentum.z();
}

Budget::Budget(const JetDynamics& dynamics, std::span<const std::unique_ptr<Event>> events)
    : balance_(dynamics, events)
    , sums_(balance_.channels().size()) {
  JetEnergies nothing;
  nothing.stored.resize(balance_.stores().size());
  start_ = nothing;
  list(nothing, [this](const std::string& name, const char* unit,
                       const std::string& meaning, double) {
    columns_.push_back({name, unit, meaning});
  });
  start_.reset();
}

void Budget::begin_step(const DenseStep& step,
                        std::span<const std::unique_ptr<Event>> events) {
  if (!start_) start_ = balance_.energies(step.jet);
  step_ = &step, events_ = events, theta_ = 0;
  inner_.clear(), next_inner_ = 0;
  step.list_inner_times(inner_);
  for (const auto& e : events) {
    std::vector<double> times;
    e->list_inner_times(times);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    for (const double t : times) inner_.push_back({.time = t, .event = e.get()});
  }
  std::ranges::sort(inner_, {}, &DenseStep::InnerTime::time);
  seen_ = step.jet;
}

void Budget::end_step(double t, double theta) {
  advance(t, theta);
  step_ = nullptr;
}

void Budget::advance(double t, double theta) {
  for (; next_inner_ < inner_.size() && inner_[next_inner_].time <= t; ++next_inner_) {
    const DenseStep::InnerTime& inner = inner_[next_inner_];
    integrate(std::min((inner.time - step_->t0) / step_->h, theta));
    if (inner.event != nullptr) pass(inner);
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
    if (!inner_.empty()) {
      const std::size_t births = step_->births(step_->time(at));
      for (const LandedBead& b : seen_.landed)
        if (!step_->jet.is_landed(b.bead - births))
          for (std::size_t c = JetColumns<double>::kinematic_columns;
               c < seen_.columns().count(); ++c)
            seen_.columns().column(c)[b.bead] = step_->value(at, c, b.bead - births);
    }
    const std::span<const Flow> flows = balance_.flows(seen_);
    for (std::size_t c = 0; c < flows.size(); ++c)
      sums_[c].add(flows[c], node.weight * width * step_->h);
  }
  theta_ = theta;
}

/// Something happens and the step goes on: the jet right before and right after, as the events see it.
void Budget::pass(const DenseStep::InnerTime& inner) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  look_into_step(theta_, inner.time, std::nextafter(inner.time, -infinity));
  before_ = seen_;
  look_into_step(theta_, inner.time, inner.time);
  sums_[balance_.channel(inner.event->channel().name)].add(balance_.jump(before_, seen_),
                                                           1);
}

/// The jet at time t with what has happened to it up to `past`.
void Budget::look_into_step(double theta, double t, double past) {
  if (!inner_.empty()) seen_ = step_->jet; // the last look may have removed beads
  step_->chain_at(theta, past, seen_);
  seen_.time = t;
  balance_.prescribe(seen_);
  if (inner_.empty()) return;
  for (const auto& e : events_) e->anticipate(past, seen_);
}

void Budget::before_event(const Event& /*event*/, const JetState& jet) {
  before_ = jet;
}

void Budget::after_event(const Event& event, const JetState& jet) {
  sums_[balance_.channel(event.channel().name)].add(balance_.jump(before_, jet), 1);
}

void Budget::archive(const Archive& a) {
  const Archive own = a.part("balance");
  if (a.is_reading() && own.names().empty()) return;
  bool started = start_.has_value();
  own("started", started);
  JetEnergies start = start_.value_or(JetEnergies{});
  own("kinetic", start.kinetic), own("stored", start.stored);
  own("momentum_x", start.momentum.x()), own("momentum_y", start.momentum.y());
  own("momentum_z", start.momentum.z()), own("momentum_size", start.momentum_size);
  if (started && start.stored.size() != balance_.stores().size())
    throw InputError("the checkpoint is damaged: its energies are those of another scene");
  if (started) start_ = start;
  for (std::size_t c = 0; c < sums_.size(); ++c)
    sums_[c].archive(own.part(balance_.channels()[c].name));
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
  list(now, [&](const std::string&, const char*, const std::string&, double value) {
    row[i++] = value;
  });
}

/// All columns in their order, with the values that they have now.
template <class Add>
void Budget::list(const JetEnergies& now, const Add& add) const {
  double size = 0, residual = now.total() - start_->total();
  const auto energy = [&](const std::string& name, const std::string& meaning,
                          double value) {
    add(name, "J", meaning, value);
    size += std::abs(value);
  };
  energy("kinetic_energy", "of beads that move freely", now.kinetic);
  for (std::size_t i = 0; i < now.stored.size(); ++i)
    energy(balance_.stores()[i].energy, balance_.stores()[i].energy_meaning, now.stored[i]);
  const std::span<const Channel> channels = balance_.channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double value = sums_[c].energy;
    residual -= value;
    if (!channels[c].energy.empty())
      energy(channels[c].energy, channels[c].energy_meaning,
             channels[c].loss ? -value : value);
  }
  add("energy_residual", "J", "energy that is unaccounted for", residual);
  add("energy_residual_relative", "1",
      "the same over the sum of the magnitudes of all energies and works",
      size > 0 ? residual / size : 0);

  size = now.momentum_size;
  Vec3 rest = now.momentum - start_->momentum;
  const auto momentum = [&](const std::string& name, const std::string& meaning,
                            const Vec3& value, bool axial) {
    for (int i = 0; i < (axial ? 1 : 3); ++i)
      add(name + "_" + "xyz"[i], "kg m/s", meaning, value[i]);
  };
  momentum("momentum", "sum m v of beads that move freely", now.momentum, false);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Vec3 value = sums_[c].momentum();
    rest -= value, size += value.norm();
    if (!channels[c].momentum.empty())
      momentum(channels[c].momentum, channels[c].momentum_meaning, value,
               channels[c].axial);
  }
  momentum("momentum_residual", "momentum that is unaccounted for", rest, false);
  add("momentum_residual_relative", "1",
      "its magnitude over sum m |v| and the magnitudes of all impulses",
      size > 0 ? rest.norm() / size : 0);
}

} // namespace ehdjet
