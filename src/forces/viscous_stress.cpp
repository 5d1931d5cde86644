#include "ehdjet/forces/viscous_stress.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <utility>

#include "link_strain.hpp"
#include "link_tension.hpp"

namespace ehdjet {

ViscousStress::ViscousStress(double viscosity)
    : viscosity_(viscosity) {
  EHDJET_EXPECTS(viscosity > 0);
}

void ViscousStress::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *e = strain_rates(stage, strain_rate_, true);
  double* t = per_link(links, tension_per_length_);
  for_parts(links.first, links.last + 1,
            [=, viscosity = viscosity_](std::size_t begin, std::size_t end) {
#pragma omp simd
              for (std::size_t k = begin; k < end; ++k)
                t[k] = v[k] * viscosity * e[k] / (l[k] * l[k]);
            });
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

// With F = V eta e d/l^2, e = (w.d)/l^2:
//     dF/dw = V eta/l^2 t t^T,   dF/dd = V eta/l^2 (t (w - 2 (w.t) t)^T/l + e (I - 2 t t^T))
void ViscousStress::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const LinkMotion motion = motion_of(stage, k, true);
    const double l = links.length[k], scale = stage.volume[k] * viscosity_ / (l * l);
    const Vec3 t = links.vector(k) / l, &w = motion.velocity;
    out.add_damping(k, scale * t * t.transpose());
    out.add_pull(k,
                 scale
                     * (t * (w - 2 * w.dot(t) * t).transpose() / l
                        + motion.strain_rate * (Mat3::Identity() - 2 * t * t.transpose())));
  }
}

TermAccount ViscousStress::account() const {
  return {.channel = {.name = "dissipation",
                      .energy = "dissipated_energy",
                      .energy_meaning = "lost so far to viscosity, sum V eta e^2 over time",
                      .loss = true},
          .tells_all_power = true};
}

// The work on beads that move is - T t.(v_k - v_(k-1)) = - V eta e^2 less what the nozzle, whose
// fluid moves, does.
void ViscousStress::add_power(const Stage& stage, Exchange& exchange) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t up = links.upstream(k);
    const double e = strain_rate(stage, k), stress = viscosity_ * e, l = links.length[k];
    exchange.own.energy -= stage.volume[k] * stress * e;
    const Vec3 pull = stage.volume[k] * stress / (l * l) * links.vector(k); // T t
    // A plate that moves does work on the beads that rest on it.
    for (const auto& [end, sign] : {std::pair{up, -1.0}, {k, 1.0}})
      if (exchange.support(end) == Support::collector)
        exchange.by_support_of(end).energy += sign * pull.dot(exchange.led(end));
    const Support support = exchange.support(up);
    if (support == Support::none || support == Support::collector) continue;
    if (is_fed(stage, k))
      exchange.by_support_of(up).energy -= stage.feed->flow_rate * stress;
    else
      exchange.by_support_of(up).energy -= pull.dot(v[up] - exchange.led(up));
  }
}

void ViscousStress::add_tension(const Stage& stage, std::span<double> tension) {
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] += stage.volume[k] * viscosity_ * strain_rate(stage, k) / links.length[k];
}

} // namespace ehdjet
