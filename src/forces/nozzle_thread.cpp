#include "ehdjet/forces/nozzle_thread.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ehdjet {

void NozzleThread::add_force(const Stage& stage, Vec3View force) {
  const auto r = stage.columns.position();
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data(), *q = stage.charge.data();
  double *fx = force.x.data(), *fy = force.y.data(), *fz = force.z.data();
  const double strength = constants::coulomb * line_charge_, length = length_,
               core = radius_ * radius_;
  const double y0 = y[0], z0 = z[0];
  BeadRange targets = stage.targets.within(stage.beads());
  if (targets.begin == 0) targets.end = stage.beads(); // bead 0 feels them all
  std::array<std::array<double, 3>, most_parts> sums{};
  const auto add_part = [=, &sums](std::size_t part, std::size_t from, std::size_t to) {
    double sum_x = 0, sum_y = 0, sum_z = 0;
#pragma omp simd reduction(+ : sum_x, sum_y, sum_z)
    for (std::size_t k = from; k < to; ++k) {
      const double dy = y[k] - y0, dz = z[k] - z0;
      const double square = dy * dy + dz * dz + core, end = x[k] + length;
      const double r1 = std::sqrt(x[k] * x[k] + square), r2 = std::sqrt(end * end + square);
      const double along = strength * q[k] * (1 / r1 - 1 / r2);
      const double across = strength * q[k] / square * (end / r2 - x[k] / r1);
      fx[k] += along, fy[k] += across * dy, fz[k] += across * dz;
      sum_x += along, sum_y += across * dy, sum_z += across * dz;
    }
    sums[part] = {sum_x, sum_y, sum_z};
  };
  for_numbered_parts(std::max<std::size_t>(targets.begin, 1), targets.end, add_part);
  Vec3 sum = Vec3::Zero();
  for (const auto& [sum_x, sum_y, sum_z] : sums) sum += Vec3(sum_x, sum_y, sum_z);
  force.add(0, -sum);
}

TermAccount NozzleThread::account() const {
  return {.energy = "nozzle_charge_energy",
          .energy_meaning = "of the jet in the field of the charge in the nozzle"};
}

double NozzleThread::potential(const Stage& stage, std::size_t bead) const {
  const auto r = stage.columns.position();
  const Vec3 d = r[bead] - r[0];
  const double s = std::sqrt(d.y() * d.y() + d.z() * d.z() + radius_ * radius_);
  return constants::coulomb * line_charge_
         * (std::asinh((d.x() + length_) / s) - std::asinh(d.x() / s));
}

double NozzleThread::energy(const Stage& stage) {
  double energy = 0;
  for (std::size_t k = 1; k < stage.beads(); ++k)
    energy += stage.charge[k] * potential(stage, k);
  return energy;
}

double NozzleThread::feeding_power(const Stage& stage, const LinkContent& rate) {
  return rate.charge * potential(stage, 1);
}

} // namespace ehdjet
