#include "ehdjet/events/insertion.hpp"

#include "ehdjet/events/root.hpp"

#include <numbers>

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

NewBead NewBead::from(double radius, double link_length, double density,
                      double charge_density) {
  const double volume = std::numbers::pi * radius * radius * link_length;
  return {.volume = volume, .mass = density * volume, .charge = charge_density * volume};
}

bool Insertion::due(const JetState& jet) const {
  return !jet.has_embryo && !jet.is_landed(1)
         && distance_to_nozzle(jet, 1) >= embryo_.creation_distance();
}

double Insertion::excess(const DenseStep& step, double theta) const {
  const Vec3 nozzle = nozzle_.position(step.time(theta));
  return (step.position(theta, 1) - nozzle).norm() - embryo_.creation_distance();
}

std::optional<double> Insertion::locate(const DenseStep& step) {
  if (step.jet.has_embryo || step.jet.is_landed(1)) return std::nullopt;
  return first_crossing([&](double theta) { return excess(step, theta); });
}

std::optional<double> Insertion::predict(const DenseStep& step) const {
  if (step.jet.has_embryo || step.jet.is_landed(1)) return std::nullopt;
  return expected_crossing(excess(step, 0), excess(step, 1), recession(step, nozzle_, 1));
}

void Insertion::apply(EventContext& context) {
  JetState& jet = context.jet;
  Ledger& ledger = context.ledger;
  NewBead born = born_;
  ++ledger.inserted_beads;
  if (varicosity_ && ledger.inserted_beads % varicosity_->every == 0) {
    born.volume *= varicosity_->volume;
    born.mass *= varicosity_->mass;
    born.charge *= varicosity_->charge;
  }
  const auto r = jet.columns().position();
  insert_bead(jet, 1,
              {.position = embryo_.position(r[0], r[1]),
               .velocity = {nozzle_.fluid_velocity, 0, 0},
               .stress = 0,
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
  return jet.has_embryo && distance_to_nozzle(jet, 2) >= embryo_.release_distance();
}

double Release::excess(const DenseStep& step, double theta) const {
  const Vec3 nozzle = nozzle_.position(step.time(theta));
  return (step.position(theta, 2) - nozzle).norm() - embryo_.release_distance();
}

std::optional<double> Release::locate(const DenseStep& step) {
  if (!step.jet.has_embryo) return std::nullopt;
  return first_crossing([&](double theta) { return excess(step, theta); });
}

std::optional<double> Release::predict(const DenseStep& step) const {
  if (!step.jet.has_embryo) return std::nullopt;
  return expected_crossing(excess(step, 0), excess(step, 1), recession(step, nozzle_, 2));
}

void Release::apply(EventContext& context) {
  JetState& jet = context.jet;
  const auto v = jet.columns().velocity();
  const double vs = nozzle_.fluid_velocity;
  Vec3 velocity(vs, 0, 0);
  if (velocity_ == ReleaseVelocity::half) velocity = (v[2] + velocity) / 2;
  v.set(1, velocity);
  jet.has_embryo = false;
  context.ledger.release_speed = velocity.norm();
  ++context.statistics.releases;
}

} // namespace ehdjet
