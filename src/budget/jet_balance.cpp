#include "ehdjet/budget/jet_balance.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ehdjet {
namespace {

std::size_t upstream_of(const Links& links, std::size_t k) {
  return k == links.first ? 0 : k - 1;
}
Vec3 vector_of(const Links& links, std::size_t k) {
  return {links.dx[k], links.dy[k], links.dz[k]};
}

/// Potential [V] and field [V/m] of all charges but one, at its place.
struct Surroundings {
  double potential = 0;
  Vec3 field = Vec3::Zero();
};
Surroundings surroundings(ConstVec3View r, std::span<const double> q, std::size_t of) {
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data();
  const double x0 = x[of], y0 = y[of], z0 = z[of];
  double potential = 0, ex = 0, ey = 0, ez = 0;
#pragma omp simd reduction(+ : potential, ex, ey, ez)
  for (std::size_t j = 0; j < q.size(); ++j) {
    const double dx = x0 - x[j], dy = y0 - y[j], dz = z0 - z[j];
    const double square = dx * dx + dy * dy + dz * dz;
    const double v = square > 0 ? q[j] / std::sqrt(square) : 0.0; // coincident: not at all
    const double e = square > 0 ? v / square : 0.0;
    potential += v;
    ex += e * dx, ey += e * dy, ez += e * dz;
  }
  return {constants::coulomb * potential, constants::coulomb * Vec3(ex, ey, ez)};
}

/// Energy of the pairs that have a member in [begin, end) [J].
double energy_of_some(ConstVec3View r, std::span<const double> q, std::size_t begin,
                      std::size_t end) {
  const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data(), *charge = q.data();
  double energy = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double xi = x[i], yi = y[i], zi = z[i];
    const auto potential = [=](std::size_t first, std::size_t last) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (std::size_t j = first; j < last; ++j) {
        const double dx = xi - x[j], dy = yi - y[j], dz = zi - z[j];
        const double square = dx * dx + dy * dy + dz * dz;
        sum += square > 0 ? charge[j] / std::sqrt(square) : 0.0;
      }
      return sum;
    };
    energy += q[i] * (potential(0, i) + potential(end, r.size()));
  }
  return constants::coulomb * energy;
}

} // namespace

void JetBalance::prescribe(JetState& jet) const {
  if (!terms_.source) return;
  const auto& [nozzle, embryo] = *terms_.source;
  const auto c = jet.columns();
  c.position().set(0, nozzle.position(jet.time));
  c.velocity().set(0, nozzle.velocity(jet.time));
  if (jet.has_embryo)
    c.position().set(1, embryo.position(c.position()[0], c.position()[2]));
}

void JetBalance::look_at(const JetState& jet) {
  const std::size_t n = jet.beads();
  charge_ = jet.charge;
  has_embryo_ = jet.has_embryo;
  const auto r = jet.columns().position();
  if (has_embryo_) {
    EHDJET_EXPECTS(terms_.source);
    embryo_charge_ = jet.charge[1];
    charge_[1] *= terms_.source->embryo.charge_fraction((r[2] - r[0]).norm());
  }
  free_.assign(n, 1), landed_.assign(n, 0);
  if (terms_.source || terms_.first_held) free_[0] = 0;
  if (has_embryo_) free_[1] = 0;
  if (terms_.last_held) free_[n - 1] = 0;
  for (const LandedBead& b : jet.landed) free_[b.bead] = 0, landed_[b.bead] = 1;
  held_.clear();
  for (std::size_t k = 0; k < n; ++k)
    if (free_[k] == 0) held_.push_back(k);

  stage_.time = jet.time, stage_.columns = jet.columns();
  stage_.mass = jet.mass, stage_.charge = charge_, stage_.volume = jet.volume;
  stage_.first = jet.first(), stage_.landed = jet.landed;
  stage_.invalidate();
}

JetEnergies JetBalance::energies(const JetState& jet) {
  JetEnergies e = all_but_coulomb(jet);
  if (terms_.coulomb) e.coulomb = terms_.coulomb->energy(jet.columns().position(), charge_);
  return e;
}

Flow JetBalance::jump(const JetState& before, const JetState& after) {
  const JetEnergies a = all_but_coulomb(before), b = all_but_coulomb(after);
  Flow flow{.energy = b.total() - a.total(), .momentum = b.momentum - a.momentum};
  if (terms_.coulomb) flow.energy += coulomb_jump(before, after);
  return flow;
}

/// Beads at both ends of the chain that have kept place and charge bring no change but with those
/// between.
double JetBalance::coulomb_jump(const JetState& before, const JetState& after) {
  look_at(before);
  charge_before_.swap(charge_);
  look_at(after);
  const auto r = before.columns().position(), s = after.columns().position();
  const std::size_t m = before.beads(), n = after.beads(), shorter = std::min(m, n);
  const auto same = [&](std::size_t i, std::size_t j) {
    return r[i] == s[j] && charge_before_[i] == charge_[j];
  };
  std::size_t head = 0, tail = 0;
  while (head < shorter && same(head, head)) ++head;
  while (head + tail < shorter && same(m - 1 - tail, n - 1 - tail)) ++tail;
  constexpr std::size_t few = 32;
  if (m + n - 2 * (head + tail) > few)
    return terms_.coulomb->energy(s, charge_) - terms_.coulomb->energy(r, charge_before_);
  return energy_of_some(s, charge_, head, n - tail)
         - energy_of_some(r, charge_before_, head, m - tail);
}

JetEnergies JetBalance::all_but_coulomb(const JetState& jet) {
  look_at(jet);
  const auto c = jet.columns();
  const auto r = c.position(), v = c.velocity();
  JetEnergies e;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    if (free_[k] != 0) {
      e.momentum += jet.mass[k] * v[k];
      e.momentum_size += jet.mass[k] * v[k].norm();
      e.kinetic += jet.mass[k] * v[k].squaredNorm() / 2;
    }
    if (terms_.field) e.field -= charge_[k] * *terms_.field * r.x[k];
    if (terms_.gravity && !(has_embryo_ && k == 1))
      e.gravity -= jet.mass[k] * *terms_.gravity * r.x[k];
  }
  const Links& links = stage_.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const double volume = jet.volume[k];
    if (terms_.fluid) {
      const double stress = c.stress()[k];
      e.elastic += volume * stress * stress / (2 * terms_.fluid->elastic_modulus);
    }
    if (terms_.line_tension)
      e.surface +=
          2 * *terms_.line_tension * std::sqrt(std::numbers::pi * volume * links.length[k]);
  }
  return e;
}

Flows JetBalance::flows(const JetState& jet) {
  look_at(jet);
  Flows flows;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    if (free_[k] == 0) continue;
    if (terms_.field) flows[Channel::field].momentum.x() += charge_[k] * *terms_.field;
    if (terms_.gravity)
      flows[Channel::gravity].momentum.x() += jet.mass[k] * *terms_.gravity;
  }
  if (terms_.fluid) add_fluid(flows);
  if (terms_.line_tension) add_line_tension(flows);
  if (terms_.surface_tension) add_surface_tension(flows);
  if (terms_.coulomb) add_coulomb(flows);
  if (has_embryo_) add_embryo(flows);
  return flows;
}

Channel JetBalance::support(std::size_t bead) const {
  if (landed_[bead] != 0) return Channel::landing;
  if (bead == 0 && terms_.source) return Channel::nozzle;
  if (bead == 1 && has_embryo_) return Channel::insertion;
  return Channel::held;
}

/// dr/dt of a bead that does not move freely. The nozzle stays at x = 0; v_s is that of the fluid.
Vec3 JetBalance::motion(std::size_t held) const {
  if (!terms_.source || landed_[held] != 0 || held > 1) return Vec3::Zero();
  Vec3 nozzle = stage_.columns.velocity()[0];
  nozzle.x() = 0;
  if (held == 0) return nozzle;
  // The embryo, at l u from the nozzle, u the direction from there to bead 2.
  const auto r = stage_.columns.position();
  const Vec3 segment = r[2] - r[0], u = segment.normalized();
  const Vec3 rate = stage_.columns.velocity()[2] - nozzle;
  return nozzle
         + terms_.source->embryo.link_length / segment.norm() * (rate - rate.dot(u) * u);
}

/// The stress of a link follows its ends: T t.(v_k - v_(k-1)) = d/dt V sigma^2/(2 G) + V
/// sigma^2/mu. The end that does not move freely does the work that the free end does not account
/// for. The stress of a link whose own bead has landed stays what it is.
void JetBalance::add_fluid(Flows& flows) const {
  const Links& links = stage_.links();
  const auto v = stage_.columns.velocity();
  const auto stress = stage_.columns.stress();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t up = upstream_of(links, k);
    const double volume = stage_.volume[k], l = links.length[k];
    const Vec3 pull = volume * stress[k] / (l * l) * vector_of(links, k); // T t
    if (landed_[k] == 0) {
      flows[Channel::dissipation].energy -=
          volume * stress[k] * stress[k] / terms_.fluid->viscosity;
      if (free_[up] == 0 && landed_[up] == 0)
        flows[support(up)].energy -= pull.dot(v[up]); // v_s included: fluid is fed
    } else if (free_[up] != 0) {
      flows[support(k)].energy += pull.dot(v[up]);
    }
    if (free_[k] == 0) flows[support(k)].momentum += pull;
    if (free_[up] == 0) flows[support(up)].momentum -= pull;
  }
}

void JetBalance::add_line_tension(Flows& flows) const {
  const Links& links = stage_.links();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t up = upstream_of(links, k);
    const double l = links.length[k];
    const Vec3 pull = *terms_.line_tension
                      * std::sqrt(std::numbers::pi * stage_.volume[k] / l) / l
                      * vector_of(links, k);
    if (free_[k] == 0) flows[support(k)].momentum += pull;
    if (free_[up] != 0) continue;
    flows[support(up)].energy -= pull.dot(motion(up));
    flows[support(up)].momentum -= pull;
  }
}

void JetBalance::add_surface_tension(Flows& flows) {
  const std::size_t n = stage_.beads();
  force_.assign(3 * n, 0.0);
  const std::span<double> f(force_);
  const Vec3View force{f.subspan(0, n), f.subspan(n, n), f.subspan(2 * n, n)};
  terms_.surface_tension->add_force(stage_, force);
  const auto v = stage_.columns.velocity();
  Flow& surface = flows[Channel::surface];
  for (std::size_t k = 0; k < n; ++k) {
    if (free_[k] == 0) continue;
    surface.energy += force[k].dot(v[k]);
    surface.momentum += force[k];
  }
}

void JetBalance::add_coulomb(Flows& flows) const {
  const auto r = stage_.columns.position();
  for (const std::size_t k : held_) {
    const Vec3 force = charge_[k] * surroundings(r, charge_, k).field;
    flows[support(k)].momentum -= force;
    flows[support(k)].energy -= force.dot(motion(k));
  }
}

/// Charge is brought to the embryo against the potential there, and the embryo is led against the
/// field (its Coulomb force is among those above).
void JetBalance::add_embryo(Flows& flows) const {
  const auto r = stage_.columns.position(), v = stage_.columns.velocity();
  Vec3 nozzle = v[0];
  nozzle.x() = 0;
  const Vec3 segment = r[2] - r[0];
  const double d = segment.norm(), rate = segment.dot(v[2] - nozzle) / d;
  const double current =
      embryo_charge_ * terms_.source->embryo.charge_fraction_slope(d) * rate; // [A]
  double& energy = flows[Channel::insertion].energy;
  if (terms_.coulomb) energy += current * surroundings(r, charge_, 1).potential;
  if (terms_.field)
    energy -= *terms_.field * (current * r.x[1] + charge_[1] * motion(1).x());
}

} // namespace ehdjet
