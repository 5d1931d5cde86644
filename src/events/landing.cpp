#include "ehdjet/events/landing.hpp"

#include "ehdjet/events/root.hpp"

#include <algorithm>

namespace ehdjet {
// Beads that have not landed and for which `reached` is true. An embryo never lands.
template <class Reached, class Found>
void Landing::for_each_arrival(const JetState& jet, const Reached& reached,
                               const Found& found) const {
  for (std::size_t k = jet.has_embryo ? jet.first() : first_bead_; k < jet.beads(); ++k)
    if (reached(k) && !jet.is_landed(k)) found(k);
}

bool Landing::due(const JetState& jet) const {
  const auto x = jet.columns().position().x;
  bool any = false;
  for_each_arrival(
      jet, [&](std::size_t k) { return x[k] >= distance_; },
      [&](std::size_t) { any = true; });
  return any;
}

std::optional<double> Landing::locate(const DenseStep& step) {
  const auto x1 = step.end_x();
  located_.reset();
  std::optional<double> earliest;
  for_each_arrival(
      step.jet, [&](std::size_t k) { return x1[k] >= distance_; },
      [&](std::size_t k) {
        const auto theta = first_crossing([&](double s) {
                             return step.x(s, k) - distance_;
                           }).value_or(1.0);
        if (!earliest || theta < *earliest) earliest = theta, located_ = k;
      });
  return earliest;
}

std::optional<double> Landing::predict(const DenseStep& step) const {
  std::size_t k = step.jet.links();
  while (k >= step.jet.first() && step.jet.is_landed(k)) --k;
  if (k < step.jet.first()) return std::nullopt;
  return expected_crossing(step.x(0, k) - distance_, step.x(1, k) - distance_,
                           step.h * step.velocity(1, k).x());
}

void Landing::apply(EventContext& context) {
  JetState& jet = context.jet;
  if (located_) {
    land(context, *located_);
  } else {
    const auto x = jet.columns().position().x;
    std::vector<std::size_t> arrived;
    for_each_arrival(
        jet, [&](std::size_t k) { return x[k] >= distance_; },
        [&](std::size_t k) { arrived.push_back(k); });
    for (const std::size_t k : arrived) land(context, k);
  }
  located_.reset();
  while (jet.links() > 1 && jet.is_landed(jet.links()) && jet.is_landed(jet.links() - 1))
    remove_leading(context);
}

void Landing::land(EventContext& context, std::size_t bead) const {
  JetState& jet = context.jet;
  jet.columns().position().x[bead] = distance_;
  const std::size_t link = bead > 0 ? bead : jet.first(); // bead 0 owns none
  const double radius = link_radius(jet.volume[link], link_length(jet, link));
  const LandedBead landed{.bead = bead, .time = jet.time, .radius = radius};
  jet.landed.insert(std::ranges::upper_bound(jet.landed, bead, {}, &LandedBead::bead),
                    landed);
  context.ledger.impact_speed = jet.columns().velocity()[bead].norm();
  context.ledger.collector_radius = radius;
  ++context.statistics.landings;
}

void Landing::remove_leading(EventContext& context) const {
  JetState& jet = context.jet;
  const std::size_t leading = jet.links();
  const LandedBead& landed = jet.landed.back();
  const DepositedBead deposited{
      .time = landed.time,
      .removal_time = jet.time,
      .bead = bead_at(jet, leading),
      .landing_radius = landed.radius,
      .radius = link_radius(jet.volume[leading], link_length(jet, leading))};
  Ledger& ledger = context.ledger;
  ++ledger.removed_beads;
  ledger.removed_mass += deposited.bead.mass;
  ledger.removed_charge += deposited.bead.charge;
  ledger.removed_volume += deposited.bead.volume;
  remove_leading_bead(jet);
  context.deposited.push_back(deposited);
}

} // namespace ehdjet
