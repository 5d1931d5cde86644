#include "ehdjet/events/landing.hpp"

#include "ehdjet/events/root.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace ehdjet {
namespace {

bool leading_may_go(const JetState& jet) {
  return jet.links() > 1 && jet.is_landed(jet.links()) && jet.is_landed(jet.links() - 1);
}

} // namespace

// Beads that have not landed and for which `reached` is true. An embryo never lands.
template <class Reached, class Found>
void Landing::for_each_arrival(const JetState& jet, const Reached& reached,
                               const Found& found) const {
  for (std::size_t k = jet.has_embryo ? jet.first() : options_.first_bead; k < jet.beads();
       ++k)
    if (reached(k) && !jet.is_landed(k)) found(k);
}

Channel Landing::channel() const {
  return {.name = "landing",
          .energy = "landing_energy",
          .energy_meaning =
              "brought in so far at the collector: beads stopped and removed, "
              "links of landed beads",
          .momentum = "landing_momentum",
          .momentum_meaning =
              "brought in so far by beads that land, and by the pull of those that have"};
}

bool Landing::due(const JetState& jet) const {
  bool any = false;
  for_each_arrival(
      jet, [&](std::size_t k) { return has_arrived(jet, k); },
      [&](std::size_t) { any = true; });
  return any;
}

double Landing::touching_distance(const JetState& jet, std::size_t bead) {
  if (bead + 1 != jet.links() || !jet.is_landed(bead + 1)) return 0;
  const double area = link_volume(jet, bead + 1) / std::numbers::pi, // a^2 l
      radius = jet.landed.back().radius;
  // A link that was short when its bead landed has to shrink first.
  return std::min(std::cbrt(area), 0.1 * area / (radius * radius));
}

bool Landing::has_arrived(const JetState& jet, std::size_t bead) const {
  const ConstVec3View r = jet.columns().position();
  if (r.x[bead] >= plate_.distance) return true;
  const double touching = touching_distance(jet, bead);
  return touching > 0 && (r[bead + 1] - r[bead]).norm() <= touching;
}

std::optional<double> Landing::locate(const DenseStep& step) {
  const auto x1 = step.end_x();
  located_.reset(), passing_.clear();
  std::vector<std::pair<double, std::size_t>> found; // theta, bead
  for_each_arrival(
      step.jet, [&](std::size_t k) { return x1[k] >= plate_.distance; },
      [&](std::size_t k) {
        const auto theta = first_crossing([&](double s) {
                             return step.x(s, k) - plate_.distance;
                           }).value_or(1.0);
        found.emplace_back(theta, k);
      });
  const auto touch = first_touch(step);
  if (found.empty() && !touch) return std::nullopt;
  std::ranges::sort(found);
  if (touch && (found.empty() || *touch <= found.front().first)) {
    located_ = 1;
    return touch;
  }

  std::size_t last = step.jet.links(); // that has not landed
  while (step.jet.is_landed(last)) --last;
  bool in_order = true; // from the end of the chain on, as the right-hand side assumes
  for (std::size_t i = 0; i < found.size(); ++i) in_order &= found[i].second + i == last;
  in_order |= !step.keeps_chain(); // there the right-hand side assumes nothing
  if (!step.jet.absorbing_plane || !in_order) {
    located_ = step.jet.links() - found.front().second;
    return found.front().first;
  }
  for (const auto& [theta, k] : found) passing_.push_back(arrival_inside(step, k, theta));
  return std::nullopt;
}

// When the bead above a resting leading bead touches it.
std::optional<double> Landing::first_touch(const DenseStep& step) const {
  const std::size_t k = step.jet.links() - 1;
  if (k < std::max(step.jet.first(), options_.first_bead) || step.jet.is_landed(k))
    return std::nullopt;
  const double touching = touching_distance(step.jet, k);
  if (touching == 0) return std::nullopt;
  const Vec3 resting = step.jet.columns().position()[k + 1];
  const auto excess = [&](double theta) {
    const Vec3 taken_along = theta * step.h * plate_.velocity;
    return touching - (step.position(theta, k) - (resting + taken_along)).norm();
  };
  if (excess(0) >= 0) return std::nullopt; // then it is due without being located
  return first_crossing(excess);
}

// Beads may have other numbers after that event.
void Landing::overtaken(double time) {
  located_.reset();
  std::erase_if(passing_, [time](const Arrival& a) { return a.time > time; });
}

std::optional<double> Landing::predict(const DenseStep& step) const {
  if (step.jet.absorbing_plane) return std::nullopt;
  std::size_t k = step.jet.links();
  while (k >= step.jet.first() && step.jet.is_landed(k)) --k;
  if (k < step.jet.first()) return std::nullopt;
  return expected_crossing(step.x(0, k) - plate_.distance, step.x(1, k) - plate_.distance,
                           step.h * step.velocity(1, k).x());
}

void Landing::anticipate(double t, JetState& jet) const {
  const std::size_t end = jet.links();
  for (const Arrival& a : passing_) {
    if (a.time > t) break;
    put_on_collector(jet, end - a.from_end, a, t);
    while (leading_may_go(jet)) leave_chain(jet, a.time);
  }
}

void Landing::list_inner_times(std::vector<double>& times) const {
  for (const Arrival& a : passing_) times.push_back(a.time);
}

void Landing::apply(EventContext& context) {
  const auto arrived = arrivals(context.jet);
  const std::size_t end = context.jet.links();
  const auto passed = [this](const Arrival& a) {
    return std::ranges::find(passing_, a.from_end, &Arrival::from_end) != passing_.end();
  };
  only_passed_ = std::ranges::all_of(arrived, passed);
  located_.reset(), passing_.clear();
  for (const Arrival& a : arrived) {
    const std::size_t bead = end - a.from_end;
    put_on_collector(context.jet, bead, a, context.jet.time);
    context.ledger.impact_speed = Vec3(a.state[3], a.state[4], a.state[5]).norm();
    context.ledger.collector_radius =
        std::ranges::find(context.jet.landed, bead, &LandedBead::bead)->radius;
    ++context.statistics.landings;
    while (leading_may_go(context.jet)) remove_leading(context, a.time);
  }
  if (options_.may_pass) keep_pace(context, arrived.size());
}

// Who lands now: the bead that ended the step or, at the end of a step, all that are there, the
// last one of the chain first.
std::vector<Landing::Arrival> Landing::arrivals(const JetState& jet) const {
  if (located_) return {arrival_now(jet, *located_)};
  std::vector<Arrival> arrived;
  for_each_arrival(
      jet, [&](std::size_t k) { return has_arrived(jet, k); },
      [&](std::size_t k) {
        const std::size_t from_end = jet.links() - k;
        const auto passed = std::ranges::find(passing_, from_end, &Arrival::from_end);
        arrived.push_back(passed != passing_.end() ? *passed : arrival_now(jet, from_end));
      });
  std::ranges::sort(arrived, [](const Arrival& a, const Arrival& b) {
    return a.time != b.time ? a.time < b.time : a.from_end < b.from_end;
  });
  return arrived;
}

Landing::Arrival Landing::arrival_inside(const DenseStep& step, std::size_t bead,
                                         double theta) const {
  std::vector<double> state{plate_.distance};
  for (std::size_t c = 1; c < step.jet.table->integrated().size(); ++c)
    state.push_back(step.value(theta, c, bead));
  const Vec3 position(state[0], state[1], state[2]);
  const double length = bead > options_.first_bead
                            ? (position - step.position(theta, bead - 1)).norm()
                            : link_length(step.jet, bead);
  return {.from_end = step.jet.links() - bead,
          .time = step.time(theta),
          .state = std::move(state),
          .link_length = length};
}

Landing::Arrival Landing::arrival_now(const JetState& jet, std::size_t from_end) const {
  const std::size_t bead = jet.links() - from_end;
  std::vector<double> state{plate_.distance};
  for (std::size_t c = 1; c < jet.table->integrated().size(); ++c)
    state.push_back(jet.columns().column(c)[bead]);
  return {
      .from_end = from_end, .time = jet.time, .state = std::move(state), .link_length = {}};
}

// The jet is at time t, until which the plate has taken the bead along.
void Landing::put_on_collector(JetState& jet, std::size_t bead, const Arrival& arrival,
                               double t) const {
  for (std::size_t c = 0; c < arrival.state.size(); ++c)
    jet.columns().column(c)[bead] = arrival.state[c];
  if (plate_.moves())
    jet.columns().position().add(bead, (t - arrival.time) * plate_.velocity);
  const std::size_t link = bead > 0 ? bead : jet.first(); // 0 owns none
  const double length = arrival.link_length.value_or(link_length(jet, link));
  const LandedBead landed{.bead = bead,
                          .time = arrival.time,
                          .radius = link_radius(link_volume(jet, link), length)};
  jet.landed.insert(std::ranges::upper_bound(jet.landed, bead, {}, &LandedBead::bead),
                    landed);
}

void Landing::remove_leading(EventContext& context, double time) const {
  JetState& jet = context.jet;
  const std::size_t leading = jet.links();
  const LandedBead& landed = jet.landed.back();
  const double length = link_length(jet, leading); // none where beads land on each other
  DepositedBead deposited{.time = landed.time,
                          .removal_time = time,
                          .bead = bead_at(jet, leading),
                          .landing_radius = landed.radius,
                          .radius = length > 0
                                        ? link_radius(link_volume(jet, leading), length)
                                        : landed.radius};
  if (plate_.moves())
    deposited.bead.position = plate_.fixed(deposited.bead.position, jet.time);
  Ledger& ledger = context.ledger;
  ++ledger.removed_beads;
  ledger.removed_mass += deposited.bead.mass;
  ledger.removed_charge += deposited.bead.charge;
  ledger.removed_volume += deposited.bead.volume;
  leave_chain(jet, time);
  context.deposited.push_back(deposited);
}

// The leading bead leaves, and its charge may stay on the collector.
void Landing::leave_chain(JetState& jet, double time) const {
  if (options_.charges_mat) {
    const std::size_t leading = jet.links();
    const Vec3 place = plate_.fixed(jet.columns().position()[leading], jet.time);
    jet.mat = with_charge(jet.mat, place, jet.charge[leading], time, options_.decay_time);
  }
  remove_leading_bead(jet);
}

// Beads pass once a landing would end every sixth step, and land in steps of their own again when
// that would not matter any more.
void Landing::keep_pace(EventContext& context, std::size_t landings) {
  constexpr double frequent = 6, rare = 12, memory = 8; // in steps, steps and landings
  const auto steps = static_cast<double>(context.statistics.steps - last_step_);
  last_step_ = context.statistics.steps;
  const double each = steps / static_cast<double>(landings);
  for (std::size_t i = 0; i < landings; ++i)
    steps_per_landing_ += (each - steps_per_landing_) / memory;
  const auto jets = static_cast<double>(options_.jets);
  if (steps_per_landing_ < frequent * jets) context.jet.absorbing_plane = plate_.distance;
  if (steps_per_landing_ > rare * jets) context.jet.absorbing_plane.reset();
}

} // namespace ehdjet
