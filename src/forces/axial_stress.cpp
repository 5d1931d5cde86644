#include "ehdjet/forces/axial_stress.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/forces/herschel_bulkley.hpp"
#include "ehdjet/forces/maxwell.hpp"

#include <cmath>

#include "link_strain.hpp"
#include "link_tension.hpp"

namespace ehdjet {

template <class Law>
std::vector<BeadColumn> AxialStress<Law>::columns() const {
  return {{.name = "stress",
           .unit = "Pa",
           .description = "of that link",
           .weight = "volume",
           .error_scale = 0.1 * law_.typical_modulus(),
           .stress_of_one = 1}};
}

template <class Law>
void AxialStress<Law>::bind(const BeadTable& table) {
  stress_ = table.find_integrated("stress").value();
  law_.fluid.bind(table);
}

template <class Law>
void AxialStress<Law>::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *sigma = stage.columns.column(stress_).data();
  double* t = per_link(links, tension_per_length_);
  for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) t[k] = v[k] * sigma[k] / (l[k] * l[k]);
  });
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

template <class Law>
void AxialStress<Law>::set_column_rates(const Stage& stage, JetColumns<double> rates) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  const double *l = links.length.data(), *dx = links.dx.data(), *dy = links.dy.data(),
               *dz = links.dz.data(), *vx = v.x.data(), *vy = v.y.data(), *vz = v.z.data(),
               *sigma = stage.columns.column(stress_).data();
  double* out = rates.column(stress_).data();
  const auto link = [=, law = law_](std::size_t k, std::size_t upstream) {
    const double stretching = (vx[k] - vx[upstream]) * dx[k]
                              + (vy[k] - vy[upstream]) * dy[k]
                              + (vz[k] - vz[upstream]) * dz[k];
    out[k] = law.rate(k, stretching, l[k] * l[k], sigma[k]);
  };
  for (std::size_t k = stage.targets.begin; k < links.head; ++k) out[k] = 0;
  std::size_t begin = links.beads.begin;
  if (begin == links.head && begin < links.beads.end) link(begin++, 0);
  for_parts(begin, links.beads.end, [=](std::size_t from, std::size_t to) {
#pragma omp simd
    for (std::size_t k = from; k < to; ++k) link(k, k - 1);
  });
  if (stage.feed != nullptr && links.beads.begin <= 1 && links.beads.end > 1)
    out[1] = fed_rate(stage);

  // A landed bead keeps the velocity of its impact as a record, but it rests on the plate.
  for (const LandedBead& b : stage.landed) {
    const std::size_t k = b.bead + 1;
    if (k < links.beads.begin || k >= links.beads.end) continue;
    if constexpr (Law::is_linear) {
      const Vec3& u = stage.plate_velocity;
      const double impact = (vx[b.bead] - u.x()) * dx[k] + (vy[b.bead] - u.y()) * dy[k]
                            + (vz[b.bead] - u.z()) * dz[k];
      out[k] += law_.modulus(k) * impact / (l[k] * l[k]);
    } else {
      out[k] = law_.rate(k, strain_rate(stage, k), 1, sigma[k]);
    }
  }
}

// Fluid that enters link 1 takes its section A_1 at once, which stretches it elastically:
//
//     sigma_e = sigma_in + G ln(A0/A_1),   A_1 = V_1/l_1                               (model 4.3)
template <class Law>
double AxialStress<Law>::entry_stress(const Stage& stage) const {
  const double section = stage.volume[1] / stage.links().length[1];
  return stage.feed->stress + law_.modulus(1) * std::log(stage.feed->section / section);
}

// The fluid that is in link 1 already is strained by -d ln A_1/dt: its upper end moves at Q/A_1. New
// fluid is mixed in by volume.
//
//     dsigma_1/dt = L((v_1 - w0).t_1/l_1 - Q/V_1, sigma_1) + (Q/V_1) (sigma_e - sigma_1)  (model 4.3)
template <class Law>
double AxialStress<Law>::fed_rate(const Stage& stage) const {
  const auto v = stage.columns.velocity();
  Vec3 nozzle = v[0];
  nozzle.x() = 0; // w0: the nozzle stays in its plane
  const double l = stage.links().length[1];
  const double stretching = (v[1] - nozzle).dot(stage.links().vector(1)) / (l * l);
  const double filling = stage.feed->flow_rate / stage.volume[1];
  const double sigma = stage.columns.column(stress_)[1];
  return law_.rate(1, stretching - filling, 1, sigma)
         + filling * (entry_stress(stage) - sigma);
}

// With F = V sigma d/l^2, sigma' = L((w.d)/l^2, sigma), G = dL/de:
//     dF/dd = V sigma/l^2 (I - 2 t t^T),      dF/d sigma = V d/l^2
//     d sigma'/dw = G d/l^2,                  d sigma'/dd = G/l^2 (w - 2 (w.t) t)
template <class Law>
void AxialStress<Law>::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto sigma = stage.columns.column(stress_);
  LinkDerivatives::Column& column = out.add_column(stress_);
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const LinkMotion motion = motion_of(stage, k);
    const double l = links.length[k];
    const double stiffness = law_.slope(k, motion.strain_rate) / (l * l);
    const Vec3 d = links.vector(k), t = d / l, &w = motion.velocity;
    const double area_per_length = stage.volume[k] / (l * l);
    out.add_pull(k,
                 area_per_length * sigma[k] * (Mat3::Identity() - 2 * t * t.transpose()));
    column.tension[k] += area_per_length * d;
    column.stretching[k] += stiffness * d;
    column.turning[k] += stiffness * (w - 2 * w.dot(t) * t);
    column.relaxation[k] += law_.relaxation_rate(k);
    if (!is_fed(stage, k)) continue;
    const double filling = stage.feed->flow_rate / stage.volume[k];
    column.relaxation[k] += filling;
    column.turning[k] += filling * law_.modulus(k) / (l * l) * d; // G ln(l_1)
  }
}

template <class Law>
TermAccount AxialStress<Law>::account() const {
  return {.energy = "elastic_energy",
          .energy_meaning = "sum V sigma^2/(2 G)",
          .channel = {.name = "dissipation",
                      .energy = "dissipated_energy",
                      .energy_meaning = Law::dissipation_meaning,
                      .loss = true}};
}

template <class Law>
double AxialStress<Law>::energy(const Stage& stage) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto sigma = stage.columns.column(stress_);
  double energy = 0;
  for (std::size_t k = links.first; k <= links.last; ++k)
    energy += stage.volume[k] * sigma[k] * sigma[k] / (2 * law_.modulus(k));
  return energy;
}

// d/dt V sigma^2/(2 G) = T t.(v_k - v_(k-1)) less what the law dissipates (V sigma^2/mu), with the velocity of the fluid, v_s
// included, at the nozzle. The link of a bead that has landed keeps its stress, and so its energy.
template <class Law>
void AxialStress<Law>::add_power(const Stage& stage, Exchange& exchange) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  const auto sigma = stage.columns.column(stress_);
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t up = links.upstream(k);
    const double volume = stage.volume[k], l = links.length[k];
    const Vec3 pull = volume * sigma[k] / (l * l) * links.vector(k); // T t
    const bool up_moves = exchange.support(up) == Support::none;
    if (exchange.support(k) == Support::collector) {
      exchange.by_support_of(k).energy +=
          pull.dot((up_moves ? v[up] : exchange.led(up)) - exchange.led(k));
      continue;
    }
    const double e = Law::is_linear ? 0.0 : strain_rate(stage, k);
    exchange.own.energy -= law_.dissipation(k, volume, e, sigma[k]);
    if (is_fed(stage, k)) {
      // New fluid brings sigma_e^2/(2 G) per volume, and loses (sigma - sigma_e)^2/(2 G) when it is
      // mixed in; that it flows in against the tension costs Q sigma.
      const double sigma_1 = sigma[k], mixed = sigma_1 - entry_stress(stage);
      exchange.by_support_of(up).energy -=
          stage.feed->flow_rate * sigma_1 * (1 + mixed / law_.modulus(k));
      continue;
    }
    if (!up_moves && exchange.support(up) != Support::collector)
      exchange.by_support_of(up).energy -= pull.dot(v[up] - exchange.led(up));
  }
}

template <class Law>
double AxialStress<Law>::feeding_power(const Stage& stage, const LinkContent& rate) {
  law_.fluid.look_at(stage);
  const double sigma = stage.columns.column(stress_)[1];
  return rate.volume * sigma * sigma / (2 * law_.modulus(1));
}

template <class Law>
void AxialStress<Law>::add_tension(const Stage& stage, std::span<double> tension) {
  const Links& links = stage.links();
  const auto sigma = stage.columns.column(stress_);
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] += stage.volume[k] * sigma[k] / links.length[k];
}

template class AxialStress<MaxwellLaw<>>;
template class AxialStress<MaxwellLaw<DryingFluid>>;
template class AxialStress<HerschelBulkleyLaw<>>;

Maxwell::Maxwell(double elastic_modulus, double viscosity)
    : AxialStress({.fluid = {.elastic_modulus = elastic_modulus,
                             .relaxation = elastic_modulus / viscosity}}) {
  EHDJET_EXPECTS(elastic_modulus > 0 && viscosity > 0);
}

HerschelBulkley::HerschelBulkley(double elastic_modulus, double viscosity,
                                 const HerschelBulkleyCurve& curve)
    : AxialStress({.fluid = {.elastic_modulus = elastic_modulus,
                             .relaxation = elastic_modulus / viscosity},
                   .curve = curve}) {
  EHDJET_EXPECTS(elastic_modulus > 0 && viscosity > 0);
  EHDJET_EXPECTS(curve.consistency >= 0 && curve.flow_index > 0 && curve.yield_stress >= 0
                 && curve.regularization >= 0);
}

} // namespace ehdjet
