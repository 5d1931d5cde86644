#pragma once

#include "ehdjet/forces/air_flow.hpp"
#include "ehdjet/forces/force_term.hpp"

#include <vector>

namespace ehdjet {

/// Law of the drag on a thread.
enum class DragLaw {
  anisotropic, ///< Marheineke & Wegener, Int. J. Multiphase Flow 37 (2011) 136
  tangential   ///< along the thread only: Ziabicki & Kawai; the law of JETSPIN
};

/// Drag coefficients across and along a thread at Reynolds numbers Re_i = 2 a |w_i|/nu (model 2.1) [-].
struct DragCoefficients {
  double normal = 0, tangential = 0;
};
/// Re > 0
[[nodiscard]] DragCoefficients drag_coefficients(DragLaw law, double normal_reynolds,
                                                 double tangential_reynolds);

/// Drag of the air on the links. With w = v - u the velocity of a bead against the air, in the parts
/// w_t = w.t along a link and w_n across it, one end of the link feels
///
///     F = - rho_air a l [ C_t(Re_t) |w_t| w_t t + C_n(Re_n) |w_n| w_n ]              (model 2.1)
///
/// units  : rho_air [kg/m^3], a, l [m], w [m/s]
/// laws   : a chain that moves with the air feels nothing; the drag takes power out of the motion
///          against the air; the force per length does not depend on the mesh
/// A dense coil entrains air: the drag of a single thread is an upper bound for it.
class AirDrag final : public ForceTerm {
public:
  AirDrag(AirFlow air, DragLaw law);
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "air drag"; }
  [[nodiscard]] TermAccount account() const override;

private:
  AirFlow air_;
  DragLaw law_;
  std::vector<double> strength_; // rho_air nu l/2 of every link [kg/s]
  std::vector<double> breadth_;  // 2 a/nu of every link [s/m]
};

/// Lift of the air on a curved thread that moves along itself: the air that it turns around pushes
/// outwards.
///
///     F_k = - rho_air l w_t^2 pi abar^2 K_k,   l = (l_k + l_(k+1))/2,   abar = (a_k + a_(k+1))/2
///
/// with w_t the velocity of the bead against the air along the chord from bead k-1 to bead k+1, and K_k
/// the curvature vector (model 2.1).
/// source : Lauricella et al., J. Phys. Chem. A 120 (2016) 4884, there for a jet in still air
class AirLift final : public ForceTerm {
public:
  explicit AirLift(AirFlow air);
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "air lift"; }
  [[nodiscard]] TermAccount account() const override;

private:
  AirFlow air_;
  std::vector<double> radius_; // of every link [m]
};

} // namespace ehdjet
