#include "ehdjet/forces/feed_momentum.hpp"

namespace ehdjet {
namespace {

double mass_rate(const Stage& stage) {
  return stage.feed->density * stage.feed->flow_rate; // rho Q
}

} // namespace

void FeedMomentum::add_force(const Stage& stage, Vec3View force) {
  const auto v = stage.columns.velocity();
  force.add(1, mass_rate(stage) * (v[0] - v[1]));
}

void FeedMomentum::add_derivatives(const Stage& stage, LinkDerivatives& derivatives) {
  derivatives.add_drag(1, mass_rate(stage) * Mat3::Identity());
}

TermAccount FeedMomentum::account() const {
  return {.channel = {.name = "inflow",
                      .energy = "inflow_energy",
                      .energy_meaning =
                          "kinetic energy so far of the fluid that has flowed in, less "
                          "what its mixing dissipates",
                      .momentum = "inflow_momentum",
                      .momentum_meaning = "so far, of the fluid that has flowed in"}};
}

// Besides the work and the impulse of the force: bead 1 grows by rho Q and keeps its velocity.
void FeedMomentum::add_power(const Stage& stage, Exchange& exchange) {
  if (exchange.support(1) != Support::none) return;
  const Vec3 v = stage.columns.velocity()[1];
  exchange.own.energy += mass_rate(stage) * v.squaredNorm() / 2;
  exchange.own.momentum += mass_rate(stage) * v;
}

} // namespace ehdjet
