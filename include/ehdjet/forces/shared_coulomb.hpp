#pragma once

#include "ehdjet/forces/force_term.hpp"

namespace ehdjet {

/// What the Coulomb forces of several jets, which are summed for all of them at once, do to one of
/// them (model 9): as a term of that jet's equations of motion.
class SharedCoulomb final : public ForceTerm {
public:
  [[nodiscard]] std::string_view name() const override { return "Coulomb"; }
  /// The forces on the beads of this jet, read at each evaluation (beads) [N].
  void read_from(ConstVec3View force) { force_ = force; }
  void add_force(const Stage& stage, Vec3View force) override;

private:
  ConstVec3View force_;
};

} // namespace ehdjet
