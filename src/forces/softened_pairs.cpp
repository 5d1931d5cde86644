#include "ehdjet/forces/softened_pairs.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "embryo_link.hpp"
#include "link_tension.hpp"

namespace ehdjet {
namespace {

double g(double x) {
  return 1 / std::sqrt(1 + x * x) - 1 / x;
}

double g_slope(double x) {
  const double square = 1 + x * x;
  return 1 / (x * x) - x / (square * std::sqrt(square));
}

} // namespace

SoftenedPairs::SoftenedPairs(const Options& options)
    : options_(options)
    , end_value_(g(options.range))
    , end_slope_(g_slope(options.range)) {
  EHDJET_EXPECTS(options.range > 0);
}

// With G(x) = g(x) - g(C) - (x - C) g'(C): dD/d(eps^2) = -(G + x G')/(2 eps^3).
SoftenedPairs::Kernel SoftenedPairs::kernel(double distance, double square) const {
  const double eps = std::sqrt(square), x = distance / eps;
  const double value = g(x) - end_value_ - (x - options_.range) * end_slope_;
  const double slope = g_slope(x) - end_slope_;
  return {.value = value / eps,
          .slope = slope / square,
          .by_square = -(value + x * slope) / (2 * square * eps)};
}

void SoftenedPairs::set_radii(const Stage& stage) {
  const std::size_t n = stage.beads();
  const auto r = stage.columns.position();
  square_.resize(n), square_slope_.resize(n);
  const std::size_t head = stage.first;
  const auto set = [&](std::size_t k, std::size_t upstream) {
    const double l = (r[k] - r[upstream]).norm();
    square_[k] = stage.volume[k] / (std::numbers::pi * l);
    square_slope_[k] = -square_[k] / l;
  };
  for (std::size_t k = head + 1; k < n; ++k) set(k, k - 1);
  if (head < n) set(head, 0);
  if (head == 2) {
    set(1, 0), square_slope_[1] = 0; // the embryo's link keeps its length
    if (options_.embryo && head < n) {
      const double l = (r[2] - r[0]).norm(), f = options_.embryo->charge_fraction(l),
                   rest = l - options_.embryo->link_length,
                   area = stage.volume[2] / std::numbers::pi;
      if (f > 0) { // before that the rest of the link may have no length
        square_[2] = area * ((1 - f) / l + f / rest);
        square_slope_[2] = -area * ((1 - f) / (l * l) + f / (rest * rest));
      }
    }
  }
  square_[0] = square_[std::min(head, n - 1)], square_slope_[0] = 0;
}

// Pairs of which a member is in [begin, end), from each bead downstream as far as they reach.
template <class Visit>
void SoftenedPairs::for_each_pair(const Stage& stage, std::size_t begin, std::size_t end,
                                  const Visit& visit) const {
  const std::size_t n = stage.beads();
  const double *x = stage.columns.position().x.data(),
               *y = stage.columns.position().y.data(),
               *z = stage.columns.position().z.data();
  const double reach = options_.range * options_.range;
  for (std::size_t i = 0; i < std::min(end, n); ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const double dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
      const double distance = dx * dx + dy * dy + dz * dz;
      const double square = (square_[i] + square_[j]) / 2;
      if (!(distance < reach * square) || !(distance > 0)) break;
      if (j < begin) continue;
      const double charges = stage.charge[i] * stage.charge[j];
      if (charges != 0) visit(i, j, charges, std::sqrt(distance), square);
    }
}

void SoftenedPairs::add_force(const Stage& stage, Vec3View force) {
  set_radii(stage);
  energy_slope_.assign(stage.beads(), 0.0);
  const auto r = stage.columns.position();
  const BeadRange targets = stage.targets.within(stage.beads());
  // The radius of bead 0 is that of the first link, and the link below the last target pulls, too.
  const std::size_t begin = targets.begin <= stage.first ? 0 : targets.begin;
  for_each_pair(
      stage, begin, targets.end + 1,
      [&](std::size_t i, std::size_t j, double charges, double distance, double square) {
        const Kernel k = kernel(distance, square);
        const Vec3 f = (-constants::coulomb * charges * k.slope / distance) * (r[i] - r[j]);
        force.add(i, f), force.add(j, -f);
        const double slope = constants::coulomb * charges * k.by_square / 2;
        energy_slope_[i] += slope, energy_slope_[j] += slope;
      });
  if (!is_free_surface()) return;
  set_link_tension(stage);
  add_link_tension(stage.links(), tension_per_length_, stage.targets, force);
}

// T_k = dU/dl_k: through the radius of bead k, and of bead 0 for the first link.
void SoftenedPairs::set_link_tension(const Stage& stage) {
  const Links& links = stage.links();
  double* t = per_link(links, tension_per_length_);
  for (std::size_t k = links.first; k <= links.last; ++k) {
    double slope = energy_slope_[k];
    if (k == stage.first) slope += energy_slope_[0];
    t[k] = slope * square_slope_[k] / links.length[k];
  }
}

TermAccount SoftenedPairs::account() const {
  if (!is_free_surface()) return ForceTerm::account();
  return {.energy = "softening_energy",
          .energy_meaning = "of softened pairs less that of point pairs"};
}

double SoftenedPairs::energy(const Stage& stage) {
  if (!is_free_surface()) return 0;
  set_radii(stage);
  double energy = 0;
  for_each_pair(stage, 0, stage.beads(),
                [&](std::size_t, std::size_t, double charges, double distance,
                    double square) { energy += charges * kernel(distance, square).value; });
  return constants::coulomb * energy;
}

// By the charge of bead 1, and by the radius of the first link: that of a link that is fed grows with its
// volume, and behind an embryo its two parts change places.
double SoftenedPairs::feeding_power(const Stage& stage, const LinkContent& rate) {
  if (!is_free_surface()) return 0;
  set_radii(stage);
  const std::size_t head = stage.first;
  double by_charge = 0, by_square = 0;
  for_each_pair(
      stage, 0, stage.beads(),
      [&](std::size_t i, std::size_t j, double charges, double distance, double square) {
        const Kernel k = kernel(distance, square);
        if (i == 1 || j == 1) by_charge += charges / stage.charge[1] * k.value;
        for (const std::size_t b : {i, j})
          if (b == head || b == 0) by_square += charges * k.by_square / 2;
      });
  double square_rate = 0;
  if (head == 1) {
    square_rate = square_[1] / stage.volume[1] * rate.volume;
  } else if (options_.embryo) {
    const double l = stage.links().length[2], rest = l - options_.embryo->link_length,
                 df_dt = charge_fraction_rate(*options_.embryo, stage);
    if (df_dt != 0) // the rest of the link may have no length
      square_rate = stage.volume[2] / std::numbers::pi * (1 / rest - 1 / l) * df_dt;
  }
  return constants::coulomb * (by_charge * rate.charge + by_square * square_rate);
}

void SoftenedPairs::add_tension(const Stage& stage, std::span<double> tension) {
  if (!is_free_surface()) return;
  std::vector<double> unused(3 * stage.beads());
  const std::span<double> all(unused);
  const std::size_t n = stage.beads();
  add_force(stage, {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)});
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] += tension_per_length_[k] * links.length[k];
}

} // namespace ehdjet
