#include "ehdjet/forces/near_field.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/parallel.hpp"

#include <cmath>
#include <numbers>

#include "embryo_link.hpp"
#include "link_tension.hpp"

namespace ehdjet {

NearField::Push& NearField::Push::add(const Push& o, double weight) {
  push += weight * o.push, slope += weight * o.slope, energy += weight * o.energy;
  return *this;
}

// eta = sqrt(V/pi) l^(-3/2): l d eta/dl = - 3/2 eta.
NearField::Push NearField::push(double charge, double volume, double length) const {
  const double l = length, eta = std::sqrt(volume / (std::numbers::pi * l)) / l;
  const SubGrid s = sub_grid(eta);
  const double scale = constants::coulomb * charge * charge / l, w = weight(),
               strength = s.d + w * s.e;
  return {.push = scale / l * strength,
          .slope = scale / (l * l) * (-2 * strength - 1.5 * (s.e + w * s.f)),
          .energy = scale * s.d};
}

bool NearField::is_split(const Stage& stage, std::size_t k) const {
  return k == 2 && stage.first == 2 && options_.embryo.has_value();
}

NearField::Push NearField::push_of_link(const Stage& stage, std::size_t k) const {
  const double q = stage.link_charge[k], volume = stage.volume[k],
               l = stage.links().length[k];
  if (!is_split(stage, k)) return push(q, volume, l);
  const double f = options_.embryo->charge_fraction(l);
  Push mean = Push{}.add(push(q, volume, l), 1 - f);
  if (f > 0) mean.add(push(q, volume, l - options_.embryo->link_length), f);
  return mean;
}

void NearField::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *q = stage.link_charge.data();
  double* t = per_link(links, tension_per_length_);
  if (options_.softened) {
    for_parts(links.first, links.last + 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) t[k] = -push_of_link(stage, k).push / l[k];
    });
  } else {
    // The same as `push`, in a form that vectorises: d + w e = ln(l/a) - B.
    const double b = weight() + std::numbers::egamma - std::numbers::ln2;
    for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
      for (std::size_t k = begin; k < end; ++k) {
        const double slenderness =
            0.5 * std::log(std::numbers::pi * l[k] * l[k] * l[k] / v[k]); // ln(l/a)
        t[k] = -constants::coulomb * q[k] * q[k] * (slenderness - b) / (l[k] * l[k] * l[k]);
      }
    });
    if (links.first <= 2 && is_split(stage, 2)) t[2] = -push_of_link(stage, 2).push / l[2];
  }
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

// With F = T t, T = -P: dF/dd = T/l (I - t t^T) + dT/dl t t^T.
void NearField::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const Push p = push_of_link(stage, k);
    const double l = links.length[k];
    const Vec3 t = links.vector(k) / l;
    const Mat3 along = t * t.transpose();
    out.add_pull(k, -p.push / l * (Mat3::Identity() - along) - p.slope * along);
  }
}

TermAccount NearField::account() const {
  if (options_.kind == NearFieldKind::fixed) return ForceTerm::account();
  return {.energy = "near_field_energy",
          .energy_meaning = "of the charged thread less that of its beads"};
}

double NearField::energy(const Stage& stage) {
  if (options_.kind == NearFieldKind::fixed) return 0;
  const Links& links = stage.links();
  double energy = 0;
  for (std::size_t k = links.first; k <= links.last; ++k)
    energy += push_of_link(stage, k).energy;
  return energy;
}

// Of link 1 that is fed: dU/dq = 2 U/q, dU/dV = k_C q^2/l e/(2 V). Of link 2 behind an embryo: its two
// parts change places as f grows with the charge of the embryo.
double NearField::feeding_power(const Stage& stage, const LinkContent& rate) {
  if (options_.kind == NearFieldKind::fixed) return 0;
  const Links& links = stage.links();
  if (stage.first == 1) {
    const double q = stage.link_charge[1], volume = stage.volume[1], l = links.length[1];
    const SubGrid s = sub_grid(std::sqrt(volume / (std::numbers::pi * l)) / l);
    return constants::coulomb * q / l
           * (2 * s.d * rate.charge + q * s.e / (2 * volume) * rate.volume);
  }
  if (!is_split(stage, 2)) return 0;
  const double q = stage.link_charge[2], volume = stage.volume[2], l = links.length[2];
  const double df_dt = charge_fraction_rate(*options_.embryo, stage);
  if (df_dt == 0) return 0; // the rest of the link may have no length
  return df_dt
         * (push(q, volume, l - options_.embryo->link_length).energy
            - push(q, volume, l).energy);
}

void NearField::add_tension(const Stage& stage, std::span<double> tension) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] -= push_of_link(stage, k).push;
}

} // namespace ehdjet
