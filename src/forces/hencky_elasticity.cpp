#include "ehdjet/forces/hencky_elasticity.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <cmath>

#include "link_strain.hpp"
#include "link_tension.hpp"

namespace ehdjet {

HenckyElasticity::HenckyElasticity(const Options& options)
    : options_(options) {
  EHDJET_EXPECTS(options.elastic_modulus > 0 && options.nozzle_stretch > 0);
}

std::vector<BeadColumn> HenckyElasticity::columns() const {
  return {{.name = "reference_length",
           .unit = "m",
           .description = "of that link without elastic stress",
           .evolution = Evolution::carried,
           .remap = ColumnRemap::share,
           .at_birth = options_.length_at_birth / options_.nozzle_stretch}};
}

void HenckyElasticity::bind(const BeadTable& table) {
  reference_ = table.find_carried("reference_length").value();
}

// In a link that is fed, l_ref grows with the volume.
double HenckyElasticity::reference(const Stage& stage, std::size_t k) const {
  if (!is_fed(stage, k)) return stage.carried(reference_)[k];
  return stage.volume[k] / (stage.feed->section * options_.nozzle_stretch);
}

double HenckyElasticity::stress(const Stage& stage, std::size_t k) const {
  return options_.elastic_modulus * std::log(stage.links().length[k] / reference(stage, k));
}

void HenckyElasticity::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *reference = stage.carried(reference_).data();
  double* t = per_link(links, tension_per_length_);
  for_parts(links.first, links.last + 1,
            [=, g = options_.elastic_modulus](std::size_t begin, std::size_t end) {
              for (std::size_t k = begin; k < end; ++k)
                t[k] = v[k] * g * std::log(l[k] / reference[k]) / (l[k] * l[k]);
            });
  if (stage.feed != nullptr && links.first <= 1)
    t[1] = v[1] * stress(stage, 1) / (l[1] * l[1]);
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

// With F = V G ln(l/l_ref) d/l^2:   dF/dd = V/l^2 (sigma (I - 2 t t^T) + G t t^T)
void HenckyElasticity::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const double l = links.length[k], sigma = stress(stage, k);
    const Vec3 t = links.vector(k) / l;
    out.add_pull(k, stage.volume[k] / (l * l)
                        * (sigma * Mat3::Identity()
                           + (options_.elastic_modulus - 2 * sigma) * t * t.transpose()));
  }
}

TermAccount HenckyElasticity::account() const {
  return {
      .energy = "elastic_energy", .energy_meaning = "sum V sigma^2/(2 G)", .channel = {}};
}

double HenckyElasticity::energy(const Stage& stage) {
  const Links& links = stage.links();
  double energy = 0;
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const double sigma = stress(stage, k);
    energy += stage.volume[k] * sigma * sigma / (2 * options_.elastic_modulus);
  }
  return energy;
}

// The reference length grows with the volume: d/dV of V sigma^2/(2 G) with sigma = G ln(A0 l/V).
double HenckyElasticity::feeding_power(const Stage& stage, const LinkContent& rate) {
  if (stage.feed == nullptr) return 0; // an embryo is no end of a link
  const double sigma = stress(stage, 1);
  return rate.volume * (sigma * sigma / (2 * options_.elastic_modulus) - sigma);
}

void HenckyElasticity::add_tension(const Stage& stage, std::span<double> tension) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] += stage.volume[k] * stress(stage, k) / links.length[k];
}

} // namespace ehdjet
