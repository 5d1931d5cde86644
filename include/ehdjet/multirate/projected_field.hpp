#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace ehdjet {

/// The field of the inner beads at the downstream ones within a macro step, projected on Legendre
/// polynomials of degree 0 ... 3 in time (model 6.1). The charge at the nozzle grows in ramps, one per
/// birth, which the stages of a macro step would sample by chance; the projection keeps its
/// impulse and first moments, as far as the quadrature has them.
class ProjectedField final : public ForceTerm {
public:
  static constexpr std::size_t degrees = 4;

  [[nodiscard]] std::string_view name() const override {
    return "field of the inner beads";
  }
  void add_force(const Stage& stage, Vec3View force) override;

  /// No field at all.
  void clear() { beads_ = 0; }
  /// Begins a projection over [t, t + h] for beads [first, first + count).
  void begin(double t, double h, std::size_t first, std::size_t count);
  /// One node of a quadrature on [0, 1], with the field there, x, y, z: each (count).
  void add(double place, double weight, std::span<const double> field);

  /// rate of velocities (beads of the chain) += factor q/m E(t).
  void add_acceleration(double t, double factor, std::span<const double> charge,
                        std::span<const double> inverse_mass, Vec3View rate) const;

private:
  [[nodiscard]] std::array<double, degrees> polynomials(double place) const;

  double start_ = 0, length_ = 1; // [s]
  std::size_t first_ = 0, beads_ = 0;
  std::vector<double> coefficient_; // degree by degree, x, y, z: each (count)
};

} // namespace ehdjet
