#pragma once

#include "ehdjet/core/columns.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <cstddef>
#include <optional>

namespace ehdjet {

/// What a link carries (model 1).
struct LinkContent {
  double volume = 0; ///< [m^3]
  double mass = 0;   ///< [kg]
  double charge = 0; ///< [C]

  /// V = pi a^2 l,  m = rho V,  q = rho_q V
  static LinkContent of_cylinder(double radius, double length, double density,
                                 double charge_density);
};

/// A steady flow into link 1 while bead 1 moves freely (model 4.3).
struct Feed {
  double flow_rate = 0; ///< Q [m^3/s]
  double density = 0;   ///< rho [kg/m^3]
  double section = 0;   ///< A0 = pi a0^2 of the nozzle [m^2]
  double stress = 0;    ///< sigma_in, with which the fluid leaves the nozzle [Pa]
};

/// How fluid enters a jet at its nozzle, bead 0: where bead 0 is, whether bead 1 is led and what it
/// carries meanwhile. One object, which the equations of motion, the events of the inflow and
/// budgets share. `has_led_bead` is JetState::has_embryo.
class Inflow {
public:
  explicit Inflow(const Nozzle& nozzle)
      : nozzle_(nozzle) {}
  virtual ~Inflow() = default;
  Inflow(const Inflow&) = delete;
  Inflow& operator=(const Inflow&) = delete;

  [[nodiscard]] const Nozzle& nozzle() const { return nozzle_; }

  /// The jet at t = 0; declared columns have their values at birth.
  [[nodiscard]] virtual JetState start(std::shared_ptr<const BeadTable> table) const = 0;
  /// Puts bead 0, and bead 1 if it is led, in their places at time t.
  virtual void prescribe(double t, bool has_led_bead, JetColumns<double> y) const = 0;

  /// Whether what bead 1 carries as it acts differs from what it carries.
  [[nodiscard]] virtual bool changes_content(bool has_led_bead) const = 0;
  /// What bead 1 carries as it acts at time t, while it changes. `since`: JetState::fed_since.
  [[nodiscard]] virtual LinkContent acting(const LinkContent& full, double since, double t,
                                           ConstVec3View r) const = 0;
  /// How fast that grows, per second.
  [[nodiscard]] virtual LinkContent content_rate(const LinkContent& full,
                                                 JetColumns<const double> y) const = 0;
  /// dr/dt of a led bead 1 [m/s].
  [[nodiscard]] virtual Vec3 led_velocity(JetColumns<const double> y) const = 0;
  /// What flows into link 1 all the time; none: link 1 is not fed while bead 1 moves freely.
  [[nodiscard]] virtual std::optional<Feed> feed() const { return {}; }

private:
  Nozzle nozzle_;
};

} // namespace ehdjet
