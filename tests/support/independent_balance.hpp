#pragma once

#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/surface_tension.hpp"
#include "ehdjet/jet/exchange.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/nozzle.hpp"
#include "ehdjet/jet/stage.hpp"
#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/read_scene.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "support/stress.hpp"

/// Energy and momentum of a jet, worked out from the model (model 8) and not from the force terms: what
/// the accounts of the terms are compared with.
namespace ehdjet::test {

class IndependentBalance {
public:
  explicit IndependentBalance(const Scene& scene) {
    const SceneConfig& s = scene.config;
    if (s.nozzle)
      source_ = {.nozzle = {.fluid_velocity = s.nozzle->fluid_velocity(),
                            .amplitude = s.nozzle->amplitude,
                            .angular_frequency = s.nozzle->angular_frequency,
                            .phase = s.nozzle->phase},
                 .embryo = {.link_length = s.nozzle->link_length}};
    const FixedEnds fixed = s.chain ? s.chain->fixed : FixedEnds::none;
    first_held_ = fixed == FixedEnds::first || fixed == FixedEnds::both;
    last_held_ = fixed == FixedEnds::last || fixed == FixedEnds::both;
    if (s.field) field_ = field_strength(s);
    if (s.gravity) gravity_ = s.gravity->acceleration;
    if (s.viscoelasticity)
      fluid_ = {.elastic_modulus = s.viscoelasticity->elastic_modulus.value(),
                .viscosity = s.viscoelasticity->viscosity.value()};
    if (s.surface_tension && s.surface_tension->form == SurfaceTensionForm::line)
      line_tension_ = s.surface_tension->coefficient;
    else if (s.surface_tension)
      paper_ = std::make_unique<BendingSurfaceTension>(s.surface_tension->coefficient);
    has_charges_ = s.coulomb.has_value();
  }

  using Energies = std::map<std::string, double>; ///< by the names of their columns [J]
  using Flows = std::map<std::string, Flow>;      ///< by the names of the channels

  void look_at(const JetState& jet) {
    const std::size_t n = jet.beads();
    charge_ = jet.charge;
    has_embryo_ = jet.has_embryo;
    const auto r = jet.columns().position();
    if (has_embryo_) {
      EHDJET_EXPECTS(source_);
      embryo_charge_ = jet.charge[1];
      charge_[1] *= source_->embryo.charge_fraction((r[2] - r[0]).norm());
    }
    free_.assign(n, 1), landed_.assign(n, 0);
    if (source_ || first_held_) free_[0] = 0;
    if (has_embryo_) free_[1] = 0;
    if (last_held_) free_[n - 1] = 0;
    for (const LandedBead& b : jet.landed) free_[b.bead] = 0, landed_[b.bead] = 1;
    held_.clear();
    for (std::size_t k = 0; k < n; ++k)
      if (free_[k] == 0) held_.push_back(k);

    stage_.time = jet.time, stage_.columns = jet.columns();
    stage_.mass = jet.mass, stage_.charge = charge_, stage_.volume = jet.volume;
    stage_.link_charge = jet.charge;
    stage_.first = jet.first(), stage_.landed = jet.landed;
    stage_.invalidate();
  }

  Energies energies(const JetState& jet) {
    look_at(jet);
    const auto c = jet.columns();
    const auto r = c.position(), v = c.velocity();
    Energies e{{"kinetic_energy", 0}};
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      if (free_[k] != 0) e["kinetic_energy"] += jet.mass[k] * v[k].squaredNorm() / 2;
      if (field_) e["field_energy"] -= charge_[k] * *field_ * r.x[k];
      if (gravity_) e["gravity_energy"] -= jet.mass[k] * *gravity_ * r.x[k];
    }
    const Links& links = stage_.links();
    for (std::size_t k = links.first; k <= links.last; ++k) {
      const double volume = jet.volume[k];
      if (fluid_) {
        const double stress = stress_of(c)[k];
        e["elastic_energy"] += volume * stress * stress / (2 * fluid_->elastic_modulus);
      }
      if (line_tension_)
        e["surface_energy"] +=
            2 * *line_tension_ * std::sqrt(std::numbers::pi * volume * links.length[k]);
    }
    if (has_charges_) e["coulomb_energy"] = coulomb_energy(r, charge_);
    return e;
  }

  Flows flows(const JetState& jet) {
    look_at(jet);
    Flows flows;
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      if (free_[k] == 0) continue;
      if (field_) flows["field"].momentum.x() += charge_[k] * *field_;
      if (gravity_) flows["gravity"].momentum.x() += jet.mass[k] * *gravity_;
    }
    if (fluid_) add_fluid(flows);
    if (line_tension_) add_line_tension(flows);
    if (paper_) add_surface_tension(flows);
    if (has_charges_) add_coulomb(flows);
    if (has_embryo_) add_embryo(flows);
    return flows;
  }

  std::string support(std::size_t bead) const {
    if (landed_[bead] != 0) return "landing";
    if (bead == 0 && source_) return "nozzle";
    if (bead == 1 && has_embryo_) return "insertion";
    return "held";
  }

  /// dr/dt of a bead that does not move freely. The nozzle stays at x = 0; v_s is that of the fluid.
  Vec3 motion(std::size_t held) const {
    if (!source_ || landed_[held] != 0 || held > 1) return Vec3::Zero();
    Vec3 nozzle = stage_.columns.velocity()[0];
    nozzle.x() = 0;
    if (held == 0) return nozzle;
    // The embryo, at l u from the nozzle, u the direction from there to bead 2.
    const auto r = stage_.columns.position();
    const Vec3 segment = r[2] - r[0], u = segment.normalized();
    const Vec3 rate = stage_.columns.velocity()[2] - nozzle;
    return nozzle + source_->embryo.link_length / segment.norm() * (rate - rate.dot(u) * u);
  }

  /// The stress of a link follows its ends: T t.(v_k - v_(k-1)) = d/dt V sigma^2/(2 G) + V
  /// sigma^2/mu. The end that does not move freely does the work that the free end does not account
  /// for. The stress of a link whose own bead has landed stays what it is.
  void add_fluid(Flows& flows) const {
    const Links& links = stage_.links();
    const auto v = stage_.columns.velocity();
    const auto stress = stress_of(stage_.columns);
    for (std::size_t k = links.first; k <= links.last; ++k) {
      const std::size_t up = links.upstream(k);
      const double volume = stage_.volume[k], l = links.length[k];
      const Vec3 pull = volume * stress[k] / (l * l) * links.vector(k); // T t
      if (landed_[k] == 0) {
        flows["dissipation"].energy -= volume * stress[k] * stress[k] / fluid_->viscosity;
        if (free_[up] == 0 && landed_[up] == 0)
          flows[support(up)].energy -= pull.dot(v[up]); // v_s included: fluid is fed
      } else if (free_[up] != 0) {
        flows[support(k)].energy += pull.dot(v[up]);
      }
      if (free_[k] == 0) flows[support(k)].momentum += pull;
      if (free_[up] == 0) flows[support(up)].momentum -= pull;
    }
  }

  void add_line_tension(Flows& flows) const {
    const Links& links = stage_.links();
    for (std::size_t k = links.first; k <= links.last; ++k) {
      const std::size_t up = links.upstream(k);
      const double l = links.length[k];
      const Vec3 pull = *line_tension_ * std::sqrt(std::numbers::pi * stage_.volume[k] / l)
                        / l * links.vector(k);
      if (free_[k] == 0) flows[support(k)].momentum += pull;
      if (free_[up] != 0) continue;
      flows[support(up)].energy -= pull.dot(motion(up));
      flows[support(up)].momentum -= pull;
    }
  }

  void add_surface_tension(Flows& flows) {
    const std::size_t n = stage_.beads();
    force_.assign(3 * n, 0.0);
    const std::span<double> f(force_);
    const Vec3View force{f.subspan(0, n), f.subspan(n, n), f.subspan(2 * n, n)};
    paper_->add_force(stage_, force);
    const auto v = stage_.columns.velocity();
    Flow& surface = flows["surface"];
    for (std::size_t k = 0; k < n; ++k) {
      if (free_[k] == 0) continue;
      surface.energy += force[k].dot(v[k]);
      surface.momentum += force[k];
    }
  }

  void add_coulomb(Flows& flows) const {
    const auto r = stage_.columns.position();
    for (const std::size_t k : held_) {
      const Vec3 force = charge_[k] * surroundings(r, charge_, k).field;
      flows[support(k)].momentum -= force;
      flows[support(k)].energy -= force.dot(motion(k));
    }
  }

  /// Charge is brought to the embryo against the potential there, and the embryo is led against the
  /// field (its Coulomb force is among those above).
  void add_embryo(Flows& flows) const {
    const auto r = stage_.columns.position(), v = stage_.columns.velocity();
    Vec3 nozzle = v[0];
    nozzle.x() = 0;
    const Vec3 segment = r[2] - r[0];
    const double d = segment.norm(), rate = segment.dot(v[2] - nozzle) / d;
    const double current =
        embryo_charge_ * source_->embryo.charge_fraction_slope(d) * rate; // [A]
    double& energy = flows["insertion"].energy;
    if (has_charges_) energy += current * surroundings(r, charge_, 1).potential;
    if (field_) energy -= *field_ * (current * r.x[1] + charge_[1] * motion(1).x());
    if (gravity_) energy -= stage_.mass[1] * *gravity_ * motion(1).x();
  }

private:
  struct Source {
    Nozzle nozzle;
    Embryo embryo;
  };
  struct Fluid {
    double elastic_modulus = 0, viscosity = 0;
  };
  /// Potential [V] and field [V/m] of all charges but one, at its place.
  struct Surroundings {
    double potential = 0;
    Vec3 field = Vec3::Zero();
  };
  static Surroundings surroundings(ConstVec3View r, std::span<const double> q,
                                   std::size_t of) {
    const double *x = r.x.data(), *y = r.y.data(), *z = r.z.data();
    const double x0 = x[of], y0 = y[of], z0 = z[of];
    double potential = 0, ex = 0, ey = 0, ez = 0;
#pragma omp simd reduction(+ : potential, ex, ey, ez)
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double dx = x0 - x[j], dy = y0 - y[j], dz = z0 - z[j];
      const double square = dx * dx + dy * dy + dz * dz;
      const double v =
          square > 0 ? q[j] / std::sqrt(square) : 0.0; // coincident: not at all
      const double e = square > 0 ? v / square : 0.0;
      potential += v;
      ex += e * dx, ey += e * dy, ez += e * dz;
    }
    return {constants::coulomb * potential, constants::coulomb * Vec3(ex, ey, ez)};
  }

  std::optional<Source> source_;
  bool first_held_ = false, last_held_ = false, has_charges_ = false;
  std::optional<double> field_, gravity_, line_tension_;
  std::optional<Fluid> fluid_;
  std::unique_ptr<ForceTerm> paper_;
  Stage stage_;
  std::vector<double> charge_; // as they act
  std::vector<char> free_, landed_;
  std::vector<std::size_t> held_; // beads that do not move freely
  std::vector<double> force_;
  bool has_embryo_ = false;
  double embryo_charge_ = 0; // its full charge [C]
};

} // namespace ehdjet::test
