#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet::test {

/// A force of a program that uses the library: linear drag, F_k = - b v_k. It says nothing about
/// energy, so that a budget has its work and impulse under its name.
class LinearDrag final : public ForceTerm {
public:
  explicit LinearDrag(double coefficient) // b [N s/m]
      : coefficient_(coefficient) {}
  [[nodiscard]] std::string_view name() const override { return "linear drag"; }
  void add_force(const Stage& stage, Vec3View force) override {
    const auto v = stage.columns.velocity();
    const BeadRange targets = stage.targets.within(stage.beads());
    for (std::size_t k = targets.begin; k < targets.end; ++k)
      force.add(k, -coefficient_ * v[k]);
  }

private:
  double coefficient_;
};

} // namespace ehdjet::test
