#include "ehdjet/forces/external_field.hpp"

#include "ehdjet/core/parallel.hpp"

namespace ehdjet {

void ExternalField::add_force(const Stage& stage, Vec3View force) {
  const double *q = stage.charge.data(), e = strength_;
  double* fx = force.x.data();
  const BeadRange targets = stage.targets.within(stage.beads());
  for_parts(targets.begin, targets.end, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) fx[k] += q[k] * e;
  });
}

TermAccount ExternalField::account() const {
  return {.energy = "field_energy",
          .energy_meaning = "-sum q E x, charges as they act",
          .channel = {.name = "field",
                      .momentum = "field_impulse",
                      .momentum_meaning = "so far, of the field",
                      .axial = true}};
}

double ExternalField::energy(const Stage& stage) {
  double energy = 0;
  const auto x = stage.columns.position().x;
  for (std::size_t k = 0; k < stage.beads(); ++k)
    energy -= stage.charge[k] * strength_ * x[k];
  return energy;
}

double ExternalField::feeding_power(const Stage& stage, const LinkContent& rate) {
  return rate.charge * (-strength_ * stage.columns.position().x[1]);
}

} // namespace ehdjet
