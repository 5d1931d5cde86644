#include "long_jet.hpp"

#include "ehdjet/core/error.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "jets.hpp"

namespace ehdjet::validation {
namespace {

constexpr double turns = 2;

Vec3 turned(const Vec3& v, double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitX()) * v;
}

double width(const Vec3& r) {
  return std::hypot(r.y(), r.z());
}

void append(ChainBeads& chain, const Bead& b) {
  chain.x.push_back(b.position.x()), chain.y.push_back(b.position.y());
  chain.z.push_back(b.position.z()), chain.vx.push_back(b.velocity.x());
  chain.vy.push_back(b.velocity.y()), chain.vz.push_back(b.velocity.z());
  chain.others["stress_pa"].values.push_back(b.declared.empty() ? 0 : b.declared.front());
  chain.volume.push_back(b.volume);
  chain.mass.push_back(b.mass), chain.charge.push_back(b.charge);
}

} // namespace

LongJet::LongJet(double time)
    : scene_(validation::scene("table2_02")) {
  jet_ = simulate(scene_, time).jet;
  SceneConfig& c = scene_.config;
  c.field =
      FieldConfig{.potential = {}, .strength = *c.field->potential / c.collector->distance};
  c.integrator.position_scale = c.nozzle->link_length;
  c.chain = ChainConfig{.file = "", .time = {}, .fixed = FixedEnds::first};
  c.nozzle.reset(), c.collector.reset(), c.refinement.reset();
  find_turns();
}

void LongJet::find_turns() {
  const auto r = jet_.columns().position();
  angle_.assign(jet_.beads(), 0);
  for (std::size_t k = 1; k < jet_.beads(); ++k) {
    const double turn = std::atan2(r.z[k], r.y[k]) - angle_[k - 1];
    angle_[k] = angle_[k - 1] + std::remainder(turn, 2 * std::numbers::pi);
  }
  last_ = jet_.beads() - 1 - jet_.landed.size();
  first_ = last_;
  while (first_ > jet_.first()
         && std::abs(angle_[last_] - angle_[first_]) < 2 * std::numbers::pi * turns)
    --first_;
  if (first_ <= jet_.first()) throw RunError("the jet has too few turns to be continued");
}

/// Beads behind `last_` are those of the turns, moved on along the screw.
Bead LongJet::repeated(std::size_t bead) const {
  if (bead <= last_) return bead_at(jet_, bead);
  const std::size_t period = last_ - first_;
  const std::size_t times = (bead - first_ - 1) / period,
                    source = first_ + 1 + (bead - first_ - 1) % period;
  const double part = static_cast<double>(source - first_) / static_cast<double>(period);
  const Bead start = bead_at(jet_, first_), end = bead_at(jet_, last_);
  const double rise = end.position.x() - start.position.x(),
               turn = angle_[last_] - angle_[first_], n = static_cast<double>(times);

  Bead b = bead_at(jet_, source);
  // From the width of the start to that of the end at the joint: the copies begin at the width
  // where the turns end.
  const double wider = (1 - part) * (width(end.position) - width(start.position));
  const double scale = 1 + wider / width(b.position);
  b.position.y() *= scale, b.position.z() *= scale;
  b.velocity += (1 - part)
                * (turned(end.velocity, angle_[source] - angle_[last_])
                   - turned(start.velocity, angle_[source] - angle_[first_]));
  b.position = turned(b.position, n * turn) + Vec3(n * rise, 0, 0);
  b.velocity = turned(b.velocity, n * turn);
  return b;
}

Scene LongJet::scene(std::size_t beads) const {
  Scene s = scene_;
  for (std::size_t k = 0; k < beads; ++k)
    if (k != 1 || !jet_.has_embryo) append(s.chain, repeated(k));
  return s;
}

} // namespace ehdjet::validation
