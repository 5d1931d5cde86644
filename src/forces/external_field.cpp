#include "ehdjet/forces/external_field.hpp"

#include "ehdjet/core/parallel.hpp"

#include <cmath>

namespace ehdjet {

double ExternalField::strength(const Stage& stage) const {
  if (stage.field_is_off) return 0;
  if (!options_.charging_time) return options_.strength;
  return -options_.strength * std::expm1(-stage.time / *options_.charging_time);
}

void ExternalField::add_force(const Stage& stage, Vec3View force) {
  const double *q = stage.charge.data(), e = strength(stage);
  double* fx = force.x.data();
  const BeadRange targets = stage.targets.within(stage.beads());
  for_parts(targets.begin, targets.end, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) fx[k] += q[k] * e;
  });
}

TermAccount ExternalField::account() const {
  TermAccount account{.energy = "field_energy",
                      .energy_meaning = "-sum q E x, charges as they act",
                      .channel = {.name = "field",
                                  .momentum = "field_impulse",
                                  .momentum_meaning = "so far, of the field",
                                  .axial = true},
                      .of_charges_only = true};
  if (options_.is_switched || options_.charging_time) {
    account.channel.energy = "field_supply";
    account.channel.energy_meaning = "brought in so far by the change of the field in time";
  }
  return account;
}

double ExternalField::energy(const Stage& stage) {
  const double e = strength(stage);
  double energy = 0;
  const auto x = stage.columns.position().x;
  for (std::size_t k = 0; k < stage.beads(); ++k) energy -= stage.charge[k] * e * x[k];
  return energy;
}

double ExternalField::feeding_power(const Stage& stage, const LinkContent& rate) {
  return rate.charge * (-strength(stage) * stage.columns.position().x[1]);
}

// dU/dt = - sum q x dE/dt
void ExternalField::add_power(const Stage& stage, Exchange& exchange) {
  if (!options_.charging_time) return;
  const double tau = *options_.charging_time,
               rise = options_.strength / tau * std::exp(-stage.time / tau);
  const auto x = stage.columns.position().x;
  for (std::size_t k = 0; k < stage.beads(); ++k)
    exchange.own.energy -= stage.charge[k] * rise * x[k];
}

} // namespace ehdjet
