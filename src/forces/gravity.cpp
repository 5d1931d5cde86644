#include "ehdjet/forces/gravity.hpp"

#include "ehdjet/core/parallel.hpp"

namespace ehdjet {

void Gravity::add_force(const Stage& stage, Vec3View force) {
  const double *m = stage.mass.data(), g = acceleration_;
  double* fx = force.x.data();
  const BeadRange targets = stage.targets.within(stage.beads());
  for_parts(targets.begin, targets.end, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) fx[k] += m[k] * g;
  });
}

TermAccount Gravity::account() const {
  return {.energy = "gravity_energy",
          .energy_meaning = "-sum m g x",
          .channel = {.name = "gravity",
                      .momentum = "gravity_impulse",
                      .momentum_meaning = "so far, of gravity",
                      .axial = true}};
}

double Gravity::energy(const Stage& stage) {
  double energy = 0;
  const auto x = stage.columns.position().x;
  for (std::size_t k = 0; k < stage.beads(); ++k)
    energy -= stage.mass[k] * acceleration_ * x[k];
  return energy;
}

double Gravity::feeding_power(const Stage& stage, const LinkContent& rate) {
  return -rate.mass * acceleration_ * stage.columns.position().x[1];
}

} // namespace ehdjet
