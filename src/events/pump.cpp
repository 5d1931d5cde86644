#include "ehdjet/events/pump.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {

PumpInflow::PumpInflow(Nozzle nozzle, const Rule& rule)
    : InflowRule([&] {
      nozzle.fluid_velocity = rule.feed.flow_rate / rule.feed.section;
      return nozzle;
    }())
    , rule_(rule) {
  EHDJET_EXPECTS(rule.feed.flow_rate > 0 && rule.feed.section > 0 && rule.link_length > 0);
}

double PumpInflow::period() const {
  return rule_.feed.section * rule_.link_length / rule_.feed.flow_rate;
}

// Multiples of the period, so that round-off does not add up over many cuts.
double PumpInflow::next_cut(double since) const {
  return (std::round(since / period()) + 1) * period();
}

LinkContent PumpInflow::of(double volume) const {
  return {.volume = volume,
          .mass = rule_.feed.density * volume,
          .charge = rule_.charge_density * volume};
}

JetState PumpInflow::start(std::shared_ptr<const BeadTable> table) const {
  const double full = rule_.feed.section * rule_.link_length;
  const LinkContent half = of(full / 2);
  JetState jet = blank_jet(std::move(table), 0);
  insert_bead(jet, 0, {.volume = full, .mass = of(full).mass, .charge = 0});
  insert_bead(jet, 1,
              {.position = {rule_.link_length / 2, 0, 0},
               .velocity = {nozzle().fluid_velocity, 0, 0},
               .volume = half.volume,
               .mass = half.mass,
               .charge = half.charge});
  if (const auto stress = jet.table->find_integrated("stress"))
    jet.columns().column(*stress)[1] = rule_.feed.stress;
  return jet;
}

void PumpInflow::prescribe(double t, bool /*has_led_bead*/, JetColumns<double> y) const {
  y.position().set(0, nozzle().position(t));
  y.velocity().set(0, nozzle().velocity(t));
}

LinkContent PumpInflow::acting(const LinkContent& /*full*/, double since, double t,
                               ConstVec3View /*r*/) const {
  const double half = rule_.feed.section * rule_.link_length / 2;
  return of(half + rule_.feed.flow_rate * (t - since));
}

LinkContent PumpInflow::content_rate(const LinkContent& /*full*/,
                                     JetColumns<const double> /*y*/) const {
  return of(rule_.feed.flow_rate);
}

Vec3 PumpInflow::led_velocity(JetColumns<const double> /*y*/) const {
  return Vec3::Zero(); // no bead is led
}

std::vector<std::unique_ptr<Event>> PumpInflow::events() const {
  std::vector<std::unique_ptr<Event>> events;
  events.push_back(std::make_unique<FeedCut>(*this));
  return events;
}

Channel FeedCut::channel() const {
  return {.name = "insertion",
          .energy = "insertion_energy",
          .energy_meaning = "brought in so far by the cuts of the link at the nozzle",
          .momentum = "insertion_momentum",
          .momentum_meaning = "brought in so far by the cuts of the link at the nozzle"};
}

bool FeedCut::due(const JetState& jet) const {
  return jet.time >= inflow_.next_cut(jet.fed_since);
}

std::optional<double> FeedCut::locate(const DenseStep& step) {
  if (!step.keeps_chain()) return std::nullopt;
  located_ = inflow_.next_cut(step.jet.fed_since);
  if (located_ > step.time(1)) return std::nullopt;
  return std::min((located_ - step.t0) / step.h, 1.0);
}

std::optional<double> FeedCut::predict(const DenseStep& step) const {
  return (inflow_.next_cut(step.jet.fed_since) - step.t0) / step.h;
}

void FeedCut::apply(EventContext& context) {
  JetState& jet = context.jet;
  check_flow(jet);
  jet.fed_since = inflow_.next_cut(jet.fed_since);
  const LinkContent all{
      .volume = jet.volume[1], .mass = jet.mass[1], .charge = jet.charge[1]};
  const auto r = jet.columns().position(), v = jet.columns().velocity();
  // V0/2, and what has flowed in since the time of the cut if that was within the step.
  const LinkContent upper_part =
      inflow_.acting(all, jet.fed_since, jet.time, std::as_const(jet).columns().position());
  const double share = upper_part.volume / all.volume; // a third
  const Vec3 link = r[1] - r[0];
  const double section = link_volume(jet, 1) / link.norm();
  Vec3 upper = v[0] + inflow_.rule().feed.flow_rate / section * link.normalized();
  upper.x() -= inflow_.nozzle().fluid_velocity; // the nozzle stays in its plane

  Bead born = bead_at(jet, 1); // the columns of its link are those of the whole link
  const Vec3 lower = jet.is_landed(1) ? Vec3(Vec3::Zero()) : Vec3(v[1]);
  born.position = r[0] + share * link;
  born.velocity = (1 - share) * upper + share * lower;
  born.volume = upper_part.volume, born.mass = upper_part.mass;
  born.charge = upper_part.charge;
  jet.volume[1] = all.volume - born.volume;
  jet.mass[1] = all.mass - born.mass;
  jet.charge[1] = all.charge - born.charge;
  insert_bead(jet, 1, born);
  ++context.ledger.inserted_beads;
  context.ledger.release_speed = born.velocity.norm();
  ++context.statistics.insertions;
}

void FeedCut::check_flow(const JetState& jet) const {
  constexpr std::size_t near_links = 10, near_beads = 3;
  const Feed& feed = inflow_.rule().feed;
  const auto refuse = [&](const std::string& what) {
    throw RunError(fmt::format(
        "at t = {:.9g} s {}: the forces cannot carry Q = {:.4g} m^3/s away. Lower "
        "nozzle.flow_rate, or raise the field or the charge density",
        jet.time, what, feed.flow_rate));
  };
  const auto v = jet.columns().velocity();
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    const double section = link_volume(jet, k) / link_length(jet, k);
    if (k <= near_links && section > 2 * feed.section)
      refuse(fmt::format("the jet is {:.2g} times as thick as the nozzle at bead {}",
                         std::sqrt(section / feed.section), k));
    if (k <= near_beads && v.x[k] < 0)
      refuse(
          fmt::format("bead {} moves back towards the nozzle at {:.3g} m/s", k, -v.x[k]));
    if (k == near_links) break;
  }
}

} // namespace ehdjet
