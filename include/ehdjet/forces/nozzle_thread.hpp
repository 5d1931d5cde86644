#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet {

/// The charge of the fluid in the nozzle of a pump, where bead 0 carries none: a straight
/// thread along x of length L and line charge lambda that ends at bead 0 and moves with it, softened
/// by the radius a0 (model 4.3). With x, y, z from bead 0 on:
///
///     E_x = k_C lambda (1/R1 - 1/R2),   E_r = k_C lambda r/(r^2 + a0^2) ((x + L)/R2 - x/R1)
///     R1^2 = x^2 + r^2 + a0^2,   R2^2 = (x + L)^2 + r^2 + a0^2,   r^2 = y^2 + z^2
///
/// Bead 0 feels the reaction. E = -grad phi with phi = k_C lambda (asinh((x + L)/s) - asinh(x/s)), s^2 = r^2 + a0^2.
class NozzleThread final : public ForceTerm {
public:
  NozzleThread(double line_charge, double length, double radius) // [C/m], [m], [m]
      : line_charge_(line_charge)
      , length_(length)
      , radius_(radius) {}
  [[nodiscard]] std::string_view name() const override { return "nozzle charge"; }
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< sum q phi
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;

private:
  [[nodiscard]] double potential(const Stage& stage, std::size_t bead) const; // phi [V]

  double line_charge_, length_, radius_;
};

} // namespace ehdjet
