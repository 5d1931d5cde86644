#include "ehdjet/forces/images.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <gsl/gsl_sf_psi.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ehdjet {
namespace {

constexpr double zeta_3 = 1.2020569031595943; // sum i^-3

/// So many images on each side of both kinds are summed: those with the charge q at 2 h i from it, and
/// those with -q at (2 i - 1) h from its mirror place in the middle plane.
constexpr int pairs = 3;

double nearest_image(const MirroredPiece& p, double to_plate) {
  const double d = std::max(to_plate, p.radius);
  return constants::coulomb * p.charge * p.charge
         / (2 * d * std::sqrt(4 * d * d + p.length * p.length / 4));
}

} // namespace

double own_image_force(const MirroredPiece& p, const Mirrors& mirrors) {
  if (p.charge == 0) return 0;
  const double h = mirrors.distance, by_collector = nearest_image(p, h - p.x);
  if (!mirrors.both_plates) return by_collector;
  // Trial steps that are rejected later may be anywhere; GSL has no value there.
  const double u = std::clamp(p.x / h, 0.0, 1.0);
  return by_collector - nearest_image(p, p.x)
         - constants::coulomb * p.charge * p.charge / (4 * h * h)
               * (gsl_sf_psi_1(1 + u) - gsl_sf_psi_1(2 - u));
}

// With xi = x - h/2, charges q stand at xi + 2 h i and -q at - xi + (2 i - 1) h. Of those farther away
// than `pairs`, two on opposite sides give
//
//     1/|D - d| + 1/|D + d| = 2/D (1 + (d_x^2 - (d_y^2 + d_z^2)/2)/D^2 + ...)
//
// with d = r - r' for the first kind and d_x = xi + xi' for the second one. The sum of the constants
// converges to - 2 ln 2/h.
ImageForce::ImageForce(const Mirrors& mirrors, std::unique_ptr<CoulombSolver> solver)
    : mirrors_(mirrors)
    , solver_(std::move(solver)) {
  const double h = mirrors.distance;
  if (!mirrors.both_plates) {
    images_ = {{.shift = 2 * h, .direction = -1}};
    return;
  }
  constant_ = -2 * std::numbers::ln2 / h;
  even_ = 2 * zeta_3 / std::pow(2 * h, 3);
  odd_ = 2 * 0.875 * zeta_3 / std::pow(h, 3); // sum (2 i - 1)^-3
  for (int i = 1; i <= pairs; ++i) {
    const double even = 2 * h * i, odd = h * (2 * i - 1);
    for (const double side : {1.0, -1.0}) {
      images_.push_back({.shift = side * even, .direction = 1});
      images_.push_back({.shift = h + side * odd, .direction = -1});
    }
    constant_ -= 2 / even - 2 / odd;
    even_ -= 2 / std::pow(even, 3), odd_ -= 2 / std::pow(odd, 3);
  }
}

void ImageForce::mirror(const Stage& stage) {
  const BeadRange sources = stage.sources.within(stage.beads());
  const std::size_t n = sources.size();
  for (auto* column : {&x_, &y_, &z_, &charge_}) column->resize(images_.size() * n);
  const auto r = stage.columns.position();
  const double *x = r.x.data() + sources.begin, *y = r.y.data() + sources.begin,
               *z = r.z.data() + sources.begin, *q = stage.charge.data() + sources.begin;
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const Image image = images_[i];
    double *image_x = x_.data() + i * n, *image_y = y_.data() + i * n,
           *image_z = z_.data() + i * n, *image_q = charge_.data() + i * n;
    for_parts(0, n, [=](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        image_x[k] = image.shift + image.direction * x[k];
        image_y[k] = y[k], image_z[k] = z[k];
        image_q[k] = image.direction * q[k];
      }
    });
  }
}

// A bead that has passed a plate within a step feels what it would feel there.
double ImageForce::seen_at(double x) const {
  const double lowest = mirrors_.both_plates ? 0.0 : x;
  return std::clamp(x, lowest, std::max(lowest, mirrors_.distance));
}

Vec3 ImageForce::middle(const Vec3& r) const {
  return {r.x() - mirrors_.distance / 2, r.y(), r.z()};
}

ImageForce::Moments ImageForce::moments(const Vec3& d, double q) const {
  return {.charge = q,
          .dipole = q * d,
          .along = q * d.x() * d.x(),
          .across = q * (d.y() * d.y() + d.z() * d.z())};
}

ImageForce::Moments ImageForce::moments(const Stage& stage) const {
  Moments sum;
  const auto r = stage.columns.position();
  const BeadRange sources = stage.sources.within(stage.beads());
  for (std::size_t k = sources.begin; k < sources.end; ++k) {
    const Moments one = moments(middle(r[k]), stage.charge[k]);
    sum.charge += one.charge, sum.dipole += one.dipole;
    sum.along += one.along, sum.across += one.across;
  }
  return sum;
}

// Sum over charges q' of
//     q' [constant + even (dx^2 - R^2/2) - odd (sx^2 - R^2/2)],  dx = xi - xi', sx = xi + xi'
double ImageForce::rest_potential(const Moments& m, const Vec3& d) const {
  const double square = d.x() * d.x() * m.charge + m.along,
               mixed = 2 * d.x() * m.dipole.x();
  const double across = (d.y() * d.y() + d.z() * d.z()) * m.charge + m.across
                        - 2 * (d.y() * m.dipole.y() + d.z() * m.dipole.z());
  return constants::coulomb
         * (constant_ * m.charge + even_ * (square - mixed - across / 2)
            - odd_ * (square + mixed - across / 2));
}

Vec3 ImageForce::rest_field(const Moments& m, const Vec3& d) const {
  const double along =
      even_ * (d.x() * m.charge - m.dipole.x()) - odd_ * (d.x() * m.charge + m.dipole.x());
  const double y = d.y() * m.charge - m.dipole.y(), z = d.z() * m.charge - m.dipole.z();
  return constants::coulomb * Vec3(-2 * along, (even_ - odd_) * y, (even_ - odd_) * z);
}

// Images of `bead` itself are left out.
Vec3 ImageForce::field_of_others(const Stage& stage, std::size_t bead) const {
  const std::size_t begin = stage.sources.within(stage.beads()).begin,
                    n = charge_.size() / images_.size();
  Vec3 at = stage.columns.position()[bead];
  at.x() = seen_at(at.x());
  const ConstVec3View place{x_, y_, z_};
  Vec3 field = Vec3::Zero();
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const std::size_t own = std::clamp(bead, begin, begin + n) - begin;
    field += pair_sum(at, place, charge_, i * n, i * n + own).field();
    field += pair_sum(at, place, charge_, i * n + std::min(own + 1, n), i * n + n).field();
  }
  return constants::coulomb * field;
}

void ImageForce::add_force(const Stage& stage, Vec3View force) {
  constexpr double close =
      1e-2; // of the link: closer, its own image would drown the others
  mirror(stage);
  const auto r = stage.columns.position();
  const BeadRange targets = stage.targets.within(stage.beads());
  const std::size_t begin = targets.begin, count = targets.size();
  const auto of = [&](auto column) { return column.subspan(begin, count); };
  seen_.resize(count), target_.resize(count), close_.clear();
  const Links& links = stage.links();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = begin + i;
    seen_[i] = seen_at(r.x[k]), target_[i] = stage.charge[k];
    if (target_[i] == 0) continue;
    const double to_plate = mirrors_.both_plates
                                ? std::min(seen_[i], mirrors_.distance - seen_[i])
                                : mirrors_.distance - seen_[i];
    const double length =
        k >= links.first && k <= links.last ? links.length[k] : mirrors_.distance;
    if (to_plate > close * length) continue;
    close_.push_back(k);
    target_[i] = 0;
  }
  const ConstVec3View place{seen_, of(r.y), of(r.z)};
  solver_->add_force_from(
      {{x_, y_, z_}, charge_},
      {place, target_, stage.moves.empty() ? stage.moves : of(stage.moves)},
      {of(force.x), of(force.y), of(force.z)});
  for (const std::size_t k : close_)
    force.add(k, stage.charge[k] * field_of_others(stage, k));
  correct(stage, targets, force);
}

// Takes away what the sum has of a bead's own images, and adds what it does not have of far ones.
void ImageForce::correct(const Stage& stage, BeadRange targets, Vec3View force) const {
  const auto r = stage.columns.position();
  const BeadRange sources = stage.sources.within(stage.beads());
  const std::size_t begin = targets.begin, count = targets.size();
  const Moments all = mirrors_.both_plates ? moments(stage) : Moments{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = begin + i;
    const double q = stage.charge[k];
    if (q == 0) continue;
    const bool is_source = k >= sources.begin && k < sources.end;
    if (is_source && target_[i] != 0) { // its own images are in the sum
      double own = 0;
      for (const Image& image : images_) {
        const double d = seen_[i] - (image.shift + image.direction * r.x[k]);
        own += image.direction * q / (d * std::abs(d));
      }
      force.x[k] -= constants::coulomb * q * own;
    }
    if (!mirrors_.both_plates) continue;
    const Vec3 here = middle({seen_[i], r.y[k], r.z[k]});
    Vec3 field = rest_field(all, here);
    if (is_source) field -= rest_field(moments(middle(r[k]), q), here);
    force.add(k, q * field);
  }
}

TermAccount ImageForce::account() const {
  return {.energy = "image_energy",
          .energy_meaning = "of the charges and the images of all others",
          .channel = {.name = "images",
                      .momentum = "image_impulse",
                      .momentum_meaning = "so far, of the images of other charges"},
          .of_charges_only = true};
}

double ImageForce::potential_of_others(const Stage& stage, std::size_t bead,
                                       const Moments& all) const {
  const Vec3 at = stage.columns.position()[bead];
  const std::size_t n = charge_.size() / images_.size();
  const ConstVec3View place{x_, y_, z_};
  double potential = 0;
  for (std::size_t i = 0; i < images_.size(); ++i)
    potential += potential_sum(at, place, charge_, i * n, i * n + bead)
                 + potential_sum(at, place, charge_, i * n + bead + 1, i * n + n);
  potential *= constants::coulomb;
  if (!mirrors_.both_plates) return potential;
  const Vec3 here = middle(at);
  return potential + rest_potential(all, here)
         - rest_potential(moments(here, stage.charge[bead]), here);
}

double ImageForce::energy(const Stage& stage) {
  mirror(stage);
  const Moments all = moments(stage);
  double energy = 0;
  for (std::size_t k = 0; k < stage.beads(); ++k)
    if (stage.charge[k] != 0)
      energy += stage.charge[k] * potential_of_others(stage, k, all) / 2;
  return energy;
}

double ImageForce::feeding_power(const Stage& stage, const LinkContent& rate) {
  mirror(stage);
  return rate.charge * potential_of_others(stage, 1, moments(stage));
}

void OwnImages::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const BeadRange targets = stage.targets.within(stage.beads());
  const auto x = stage.columns.position().x;
  for (std::size_t k = targets.begin; k < targets.end; ++k) {
    MirroredPiece piece{.charge = stage.charge[k], .x = x[k]};
    if (k >= links.first && k <= links.last) {
      piece.length = links.length[k];
      piece.radius = link_radius(stage.volume[k], piece.length);
    }
    force.x[k] += own_image_force(piece, mirrors_);
  }
}

} // namespace ehdjet
