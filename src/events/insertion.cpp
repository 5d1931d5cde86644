#include "ehdjet/events/insertion.hpp"

#include "ehdjet/events/root.hpp"

#include <utility>

namespace ehdjet {
namespace {

double distance_to_nozzle(const JetState& jet, std::size_t bead) {
  const auto r = jet.columns().position();
  return (r[bead] - r[0]).norm();
}

// How fast a bead recedes from the nozzle at the end of a step, per step [m].
double recession(const DenseStep& step, const Nozzle& nozzle, std::size_t bead) {
  const double t1 = step.time(1);
  const Vec3 d = step.position(1, bead) - nozzle.position(t1);
  Vec3 v = step.velocity(1, bead) - nozzle.velocity(t1);
  v.x() += nozzle.fluid_velocity; // the fluid moves along x, the nozzle does not
  return step.h * v.dot(d) / d.norm();
}

} // namespace

JetState EmbryoInflow::start(std::shared_ptr<const BeadTable> table) const {
  const LinkContent& born = rule_.born;
  JetState jet = blank_jet(std::move(table), 0);
  Bead bead{.volume = born.volume, .mass = born.mass, .charge = born.charge};
  insert_bead(jet, 0, bead);
  bead.position = {rule_.link_length, 0, 0};
  bead.velocity = {nozzle().fluid_velocity, 0, 0};
  insert_bead(jet, 1, bead);
  return jet;
}

void EmbryoInflow::prescribe(double t, bool has_led_bead, JetColumns<double> y) const {
  const Vec3 place = nozzle().position(t);
  y.position().set(0, place);
  y.velocity().set(0, nozzle().velocity(t));
  if (has_led_bead) y.position().set(1, embryo_.position(place, y.position()[2]));
}

LinkContent EmbryoInflow::acting(const LinkContent& full, double /*since*/, double /*t*/,
                                 ConstVec3View r) const {
  LinkContent now = full;
  now.charge *= embryo_.charge_fraction((r[2] - r[0]).norm());
  return now;
}

LinkContent EmbryoInflow::content_rate(const LinkContent& full,
                                       JetColumns<const double> y) const {
  const auto r = y.position(), v = y.velocity();
  Vec3 nozzle_velocity = v[0];
  nozzle_velocity.x() = 0;
  const Vec3 segment = r[2] - r[0];
  const double d = segment.norm(), rate = segment.dot(v[2] - nozzle_velocity) / d;
  return {.volume = 0,
          .mass = 0,
          .charge = full.charge * embryo_.charge_fraction_slope(d) * rate};
}

// At l u from the nozzle, u the direction from there to bead 2.
Vec3 EmbryoInflow::led_velocity(JetColumns<const double> y) const {
  const auto r = y.position(), v = y.velocity();
  Vec3 nozzle_velocity = v[0];
  nozzle_velocity.x() = 0;
  const Vec3 segment = r[2] - r[0], u = segment.normalized();
  const Vec3 rate = v[2] - nozzle_velocity;
  return nozzle_velocity + rule_.link_length / segment.norm() * (rate - rate.dot(u) * u);
}

std::vector<std::unique_ptr<Event>> EmbryoInflow::events() const {
  std::vector<std::unique_ptr<Event>> events;
  events.push_back(std::make_unique<Release>(*this));
  events.push_back(std::make_unique<Insertion>(*this));
  return events;
}

Channel Insertion::channel() const {
  return {.name = "insertion",
          .energy = "insertion_energy",
          .energy_meaning = "brought in so far by embryos: charging, leading, release",
          .momentum = "insertion_momentum",
          .momentum_meaning =
              "brought in so far by embryos: their push, and at their release"};
}

Channel Release::channel() const {
  return Insertion(inflow_).channel();
}

bool Insertion::due(const JetState& jet) const {
  return !jet.has_embryo && !jet.is_landed(1)
         && distance_to_nozzle(jet, 1) >= inflow_.embryo().creation_distance();
}

double Insertion::excess(const DenseStep& step, double theta) const {
  const Vec3 nozzle = inflow_.nozzle().position(step.time(theta));
  return (step.position(theta, 1) - nozzle).norm() - inflow_.embryo().creation_distance();
}

std::optional<double> Insertion::locate(const DenseStep& step) {
  if (!step.keeps_chain() || step.jet.has_embryo || step.jet.is_landed(1))
    return std::nullopt;
  return first_crossing([&](double theta) { return excess(step, theta); });
}

std::optional<double> Insertion::predict(const DenseStep& step) const {
  if (step.jet.has_embryo || step.jet.is_landed(1)) return std::nullopt;
  return expected_crossing(excess(step, 0), excess(step, 1),
                           recession(step, inflow_.nozzle(), 1));
}

void Insertion::apply(EventContext& context) {
  JetState& jet = context.jet;
  Ledger& ledger = context.ledger;
  const EmbryoInflow::Rule& rule = inflow_.rule();
  LinkContent born = rule.born;
  ++ledger.inserted_beads;
  if (rule.varicosity && ledger.inserted_beads % rule.varicosity->every == 0) {
    born.volume *= rule.varicosity->volume;
    born.mass *= rule.varicosity->mass;
    born.charge *= rule.varicosity->charge;
  }
  const auto r = jet.columns().position();
  insert_bead(jet, 1,
              {.position = inflow_.embryo().position(r[0], r[1]),
               .velocity = {inflow_.nozzle().fluid_velocity, 0, 0},
               .volume = born.volume,
               .mass = born.mass,
               .charge = born.charge});
  jet.has_embryo = true;
  ledger.inserted_mass += born.mass;
  ledger.inserted_charge += born.charge;
  ledger.inserted_volume += born.volume;
  ++context.statistics.insertions;
}

bool Release::due(const JetState& jet) const {
  return jet.has_embryo
         && distance_to_nozzle(jet, 2) >= inflow_.embryo().release_distance();
}

double Release::excess(const DenseStep& step, double theta) const {
  const Vec3 nozzle = inflow_.nozzle().position(step.time(theta));
  return (step.position(theta, 2) - nozzle).norm() - inflow_.embryo().release_distance();
}

std::optional<double> Release::locate(const DenseStep& step) {
  if (!step.keeps_chain() || !step.jet.has_embryo) return std::nullopt;
  return first_crossing([&](double theta) { return excess(step, theta); });
}

std::optional<double> Release::predict(const DenseStep& step) const {
  if (!step.jet.has_embryo) return std::nullopt;
  return expected_crossing(excess(step, 0), excess(step, 1),
                           recession(step, inflow_.nozzle(), 2));
}

void Release::apply(EventContext& context) {
  JetState& jet = context.jet;
  const auto v = jet.columns().velocity();
  const double vs = inflow_.nozzle().fluid_velocity;
  Vec3 velocity(vs, 0, 0);
  if (inflow_.rule().release == ReleaseVelocity::half) velocity = (v[2] + velocity) / 2;
  v.set(1, velocity);
  jet.has_embryo = false;
  context.ledger.release_speed = velocity.norm();
  ++context.statistics.releases;
}

} // namespace ehdjet
