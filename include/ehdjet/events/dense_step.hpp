#pragma once

#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <cstddef>
#include <span>

namespace ehdjet {

/// A step that was taken but not yet committed, readable at any instant t0 + theta h. Dense
/// output is only prepared if a state inside the step is read.
class DenseStep {
public:
  DenseStep(double start, double length, const JetState& chain, Integrator& integrator,
            OdeSystem& system)
      : t0(start)
      , h(length)
      , jet(chain)
      , integrator_(integrator)
      , system_(system) {}

  double t0, h;        ///< [s]
  const JetState& jet; ///< the chain at t0

  [[nodiscard]] double time(double theta) const { return t0 + theta * h; }
  /// Position and velocity of a bead that is integrated (not the nozzle, not an embryo).
  [[nodiscard]] Vec3 position(double theta, std::size_t bead) const {
    return vector(theta, 0, bead);
  }
  [[nodiscard]] Vec3 velocity(double theta, std::size_t bead) const {
    return vector(theta, 3, bead);
  }
  /// Any integrated column.
  [[nodiscard]] double value(double theta, std::size_t column, std::size_t bead) const {
    return component(theta, column * jet.beads() + bead);
  }
  [[nodiscard]] double x(double theta, std::size_t bead) const {
    return component(theta, bead);
  }
  /// x of all beads at t0 + h.
  [[nodiscard]] std::span<const double> end_x() const {
    return integrator_.end_state().first(jet.beads());
  }
  /// The whole state; prescribed beads are not put in their places.
  void state(double theta, std::span<double> out) const;

private:
  [[nodiscard]] double component(double theta, std::size_t index) const;
  [[nodiscard]] Vec3 vector(double theta, std::size_t column, std::size_t bead) const {
    const std::size_t n = jet.beads(), i = column * n + bead;
    return {component(theta, i), component(theta, i + n), component(theta, i + 2 * n)};
  }

  Integrator& integrator_;
  OdeSystem& system_;
};

} // namespace ehdjet
