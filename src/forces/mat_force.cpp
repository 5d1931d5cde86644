#include "ehdjet/forces/mat_force.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <cstddef>
#include <span>
#include <utility>

namespace ehdjet {

MatForce::MatForce(const Plate& plate, std::optional<double> decay_time,
                   std::unique_ptr<CoulombSolver> solver)
    : plate_(plate)
    , decay_time_(decay_time)
    , solver_(std::move(solver))
    , few_(make_direct_sum()) {}

void MatForce::add_force(const Stage& stage, Vec3View force) {
  if (stage.mat == nullptr) return;
  const Mat& mat = *stage.mat;
  const BeadRange targets = stage.targets.within(stage.beads());
  const std::size_t begin = targets.begin, count = targets.size();
  const auto of = [&](auto column) { return column.subspan(begin, count); };
  const auto r = stage.columns.position();
  ConstVec3View place{of(r.x), of(r.y), of(r.z)};
  if (plate_.moves()) {
    y_.resize(count), z_.resize(count);
    const double dy = plate_.velocity.y() * stage.time,
                 dz = plate_.velocity.z() * stage.time;
    const double *y = place.y.data(), *z = place.z.data();
    double *shifted_y = y_.data(), *shifted_z = z_.data();
    for_parts(0, count, [=](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        shifted_y[k] = y[k] - dy, shifted_z[k] = z[k] - dz;
    });
    place.y = y_, place.z = z_;
  }
  const Vec3View out{of(force.x), of(force.y), of(force.z)};
  const PointCharges jet{place, of(stage.charge),
                         stage.moves.empty() ? stage.moves : of(stage.moves)};
  if (mat.settled)
    solver_->add_force_from({mat.settled->place(), mat.settled->charge, {}, mat.settled},
                            seen_by(*mat.settled, stage.time, jet), out);
  if (mat.recent.size() > 0)
    few_->add_force_from({mat.recent.place(), mat.recent.charge},
                         seen_by(mat.recent, stage.time, jet), out);
}

/// With the share of the charges of the mat that is left: one factor for all pairs.
PointCharges MatForce::seen_by(const MatCharges& mat, double t, PointCharges jet) {
  if (!decay_time_) return jet;
  charge_.resize(jet.size());
  const double share = mat.remaining(t, decay_time_), *q = jet.q.data();
  double* scaled = charge_.data();
  for_parts(0, jet.size(), [=](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) scaled[k] = share * q[k];
  });
  jet.q = charge_;
  return jet;
}

TermAccount MatForce::account() const {
  return {.energy = "mat_energy",
          .energy_meaning = "of the jet in the field of the mat",
          .channel = {.name = "mat",
                      .energy = "mat_exchange",
                      .energy_meaning =
                          "brought in so far by the motion and the decay of the mat",
                      .momentum = "mat_impulse",
                      .momentum_meaning = "so far, of the mat"},
          .of_charges_only = true};
}

double MatForce::potential(const Stage& stage, std::size_t bead) const {
  const Mat& mat = *stage.mat;
  const Vec3 place = plate_.fixed(stage.columns.position()[bead], stage.time);
  double sum = 0;
  mat.for_each_part([&](const MatCharges& part) {
    sum += part.remaining(stage.time, decay_time_)
           * potential_sum(place, part.place(), part.charge, 0, part.size());
  });
  return constants::coulomb * sum;
}

double MatForce::energy(const Stage& stage) {
  if (stage.mat == nullptr) return 0;
  double energy = 0;
  for (std::size_t k = 0; k < stage.beads(); ++k)
    energy += stage.charge[k] * potential(stage, k);
  return energy;
}

double MatForce::feeding_power(const Stage& stage, const LinkContent& rate) {
  return stage.mat == nullptr ? 0 : rate.charge * potential(stage, 1);
}

// dU/dt at rest = sum of F_k.U over all beads - U/tau
void MatForce::add_power(const Stage& stage, Exchange& exchange) {
  if (stage.mat == nullptr) return;
  if (decay_time_) exchange.own.energy -= energy(stage) / *decay_time_;
  if (!plate_.moves()) return;
  const std::size_t n = stage.beads();
  force_.assign(3 * n, 0.0);
  const std::span<double> f(force_);
  const Vec3View force{f.subspan(0, n), f.subspan(n, n), f.subspan(2 * n, n)};
  add_force(stage, force);
  for (std::size_t k = 0; k < n; ++k) exchange.own.energy += force[k].dot(plate_.velocity);
}

} // namespace ehdjet
