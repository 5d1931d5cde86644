#pragma once

#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/stress.hpp"
#include "support/table.hpp"
#include "support/units.hpp"

/// Scenes composed in memory, and ways to watch them run.
namespace ehdjet::test {

/// The PVP fluid at the nozzle as in scenes/pvp.toml, in the units of the published tables.
namespace pvp {
inline constexpr double density = 0.839253525 * gram / cm3;
inline constexpr double charge_density = 44000 * statC / cm3;
inline constexpr double radius = 0.005 * cm, link_length = 0.02 * cm;
inline constexpr double velocity = 0.282942121 * cm;
inline constexpr double modulus = 5e4 * dyn_cm2, viscosity = 20 * poise;
inline constexpr double relaxation_time = viscosity / modulus;
inline constexpr double surface_tension = 21.133 * dyn_cm;
inline constexpr double potential = 30.02076857 * statV, distance = 16 * cm;
inline constexpr double volume = std::numbers::pi * radius * radius * link_length;
inline constexpr double mass = density * volume, charge = charge_density * volume;
inline constexpr double gravity = 980.665 * cm;
} // namespace pvp

inline void integrate(Scene& scene, const std::string& method, double rtol_or_step) {
  IntegratorConfig& c = scene.config.integrator;
  c.method = method;
  c.rtol.reset(), c.step.reset();
  (integration_method(method).estimates_errors ? c.rtol : c.step) = rtol_or_step;
}
inline void integrate_with_fixed_steps(Scene& scene, const std::string& method,
                                       double step) {
  integrate(scene, method, step);
  scene.config.integrator.rtol.reset();
  scene.config.integrator.step = step;
}

/// Case I: the PVP jet from a rotating nozzle to the collector, without refinement.
inline Scene case_one(const std::string& method = "dormand-prince",
                      double rtol_or_step = 1e-6) {
  Scene s;
  s.config.nozzle = NozzleConfig{.radius = pvp::radius,
                                 .link_length = pvp::link_length,
                                 .velocity = pvp::velocity,
                                 .density = pvp::density,
                                 .charge_density = pvp::charge_density,
                                 .amplitude = 1e-3 * cm,
                                 .angular_frequency = 1e4};
  s.config.collector =
      CollectorConfig{.distance = pvp::distance, .charge = CollectorCharge::kept};
  s.config.field = FieldConfig{.potential = pvp::potential, .strength = {}};
  s.config.gravity = GravityConfig{pvp::gravity};
  s.config.coulomb = CoulombConfig{};
  s.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
  s.config.surface_tension = SurfaceTensionConfig{.coefficient = pvp::surface_tension};
  integrate(s, method, rtol_or_step);
  return s;
}

/// A chain scene without any force.
inline Scene chain_scene(FixedEnds fixed = FixedEnds::none) {
  Scene s;
  s.config.chain = ChainConfig{.file = "", .time = {}, .fixed = fixed};
  integrate(s, "dop853", 1e-12);
  return s;
}
inline std::vector<double>& stresses(ChainBeads& beads) {
  return beads.others["stress_pa"].values;
}
inline void add_bead(Scene& s, const Bead& b) {
  ChainBeads& c = s.chain;
  c.x.push_back(b.position.x()), c.y.push_back(b.position.y()),
      c.z.push_back(b.position.z());
  c.vx.push_back(b.velocity.x()), c.vy.push_back(b.velocity.y()),
      c.vz.push_back(b.velocity.z());
  stresses(c).push_back(stress_of(b)), c.volume.push_back(b.volume);
  c.mass.push_back(b.mass), c.charge.push_back(b.charge);
}
/// What a bead of the PVP jet carries.
inline Bead pvp_bead(const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  return {.position = position,
          .velocity = velocity,
          .volume = pvp::volume,
          .mass = pvp::mass,
          .charge = pvp::charge};
}

/// A zig-zag of twelve PVP beads whose motion was computed independently: "free" at both ends, or
/// "held" at bead 0.
struct GoldenChain {
  explicit GoldenChain(const std::string& kind)
      : beads("golden/" + kind + "_beads.csv")
      , states("golden/" + kind + "_states.csv")
      , scene(chain_scene(kind == "held" ? FixedEnds::first : FixedEnds::none)) {
    for (std::size_t k = 0; k < beads.rows(); ++k)
      add_bead(scene, {.position = position(0, k),
                       .velocity = velocity(0, k),
                       .volume = beads.at(k, "volume_cm3") * cm3,
                       .mass = beads.at(k, "mass_g") * gram,
                       .charge = beads.at(k, "charge_statC") * statC,
                       .declared = {stress(0, k)}});
    scene.config.field =
        FieldConfig{.potential = {}, .strength = 1.876298035625 * statV / cm};
    scene.config.coulomb = CoulombConfig{};
    scene.config.viscoelasticity = ViscoelasticityConfig{pvp::modulus, pvp::viscosity};
    scene.config.surface_tension =
        SurfaceTensionConfig{.coefficient = pvp::surface_tension};
  }
  [[nodiscard]] std::size_t size() const { return beads.rows(); }
  [[nodiscard]] std::size_t times() const { return states.rows() / size(); }
  [[nodiscard]] double time(std::size_t i) const { return states.at(i * size(), "t_s"); }
  [[nodiscard]] Vec3 position(std::size_t i, std::size_t k) const {
    const std::size_t row = i * size() + k;
    return cm
           * Vec3(states.at(row, "x_cm"), states.at(row, "y_cm"), states.at(row, "z_cm"));
  }
  [[nodiscard]] Vec3 velocity(std::size_t i, std::size_t k) const {
    const std::size_t row = i * size() + k;
    return cm
           * Vec3(states.at(row, "vx_cm_s"), states.at(row, "vy_cm_s"),
                  states.at(row, "vz_cm_s"));
  }
  [[nodiscard]] double stress(std::size_t i, std::size_t k) const {
    return states.at(i * size() + k, "stress_dyn_cm2") * dyn_cm2;
  }
  [[nodiscard]] Vec3 force(const std::string& term, std::size_t k) const {
    return dyn
           * Vec3(beads.at(k, term + "_x_dyn"), beads.at(k, term + "_y_dyn"),
                  beads.at(k, term + "_z_dyn"));
  }

  Table beads, states;
  Scene scene;
};

/// Calls a function at 0, dt, 2 dt, ...
class Watch final : public Observer {
public:
  using Look = std::function<void(const JetSnapshot&)>;
  Watch(double interval, Look look)
      : schedule_(interval)
      , look_(std::move(look)) {}
  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }
  void observe(const JetSnapshot& snapshot) override {
    schedule_.advance();
    look_(snapshot);
  }

private:
  Schedule schedule_;
  Look look_;
};

/// Keeps the beads that have left the chain.
class Deposit final : public Observer {
public:
  explicit Deposit(std::vector<DepositedBead>& beads)
      : beads_(beads) {}
  void deposit(const DepositedBead& bead) override { beads_.push_back(bead); }

private:
  std::vector<DepositedBead>& beads_;
};

inline std::unique_ptr<Simulation> run(const Scene& scene, double end_time) {
  auto simulation = build_simulation(scene);
  simulation->run_until(end_time);
  return simulation;
}

/// Largest distance of a bead from the same bead of another jet [m]; no number if their numbers differ.
inline double largest_distance(const JetState& a, const JetState& b) {
  if (a.beads() != b.beads()) return std::nan("");
  double largest = 0;
  for (std::size_t k = 0; k < a.beads(); ++k) {
    const double d = (a.columns().position()[k] - b.columns().position()[k]).norm();
    largest = d <= largest ? largest : d; // a NaN stays
  }
  return largest;
}

/// A straight jet onto a plate, of the fluid and in the field of the reference code's second example, whose
/// plate is 2 m away.
inline Scene straight_jet(double distance = 2) {
  Scene s;
  s.config.nozzle = NozzleConfig{.radius = 1.5e-4,
                                 .link_length = 1e-3,
                                 .velocity = 0,
                                 .density = 818.912288,
                                 .charge_density = 1.2546226};
  s.config.collector = CollectorConfig{.distance = distance};
  s.config.field = FieldConfig{.potential = distance / 2 * 83286.55, .strength = {}};
  s.config.coulomb = CoulombConfig{};
  s.config.viscoelasticity = ViscoelasticityConfig{1000, 10};
  integrate(s, "dormand-prince", 1e-5);
  return s;
}

/// Least-squares slope of log(error) over log(step): an observed order.
inline double observed_order(const std::vector<double>& steps,
                             const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = std::log(steps[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

} // namespace ehdjet::test
