#pragma once

#include "ehdjet/dynamics/acting_chain.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// Where the downstream beads will be within a macro step, before it has been made:
///
///     r + v s + a s^2/2 + j s^3/6,   s = t - T,   j = (a(T) - a(T_prev))/H_prev
///
/// and the same one order lower for velocities and declared columns (model 6.1). It guides the beads
/// at the end of the inner chain.
class Predictor final : public Guide {
public:
  /// `rate`: of all columns of that jet at its time. Both must stay where they are during the step.
  void start(const JetState& jet, std::span<const double> rate,
             std::span<const double> jerk);
  /// The beads from `first` on, in the numbers of the jet, are the last `count` beads of the inner chain.
  void lead(std::size_t first, std::size_t count) { first_ = first, count_ = count; }

  void prescribe(double t, JetColumns<double> y) const override;
  /// The places at time t of the beads from `first` on.
  void places(double t, std::size_t first, Vec3View out) const;

private:
  [[nodiscard]] double value(std::size_t column, std::size_t bead, double s) const;

  double start_ = 0; // T [s]
  std::size_t beads_ = 0;
  std::span<const double> y_, rate_, jerk_;
  std::size_t first_ = 0, count_ = 0;
};

} // namespace ehdjet
