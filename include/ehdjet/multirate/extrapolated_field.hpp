#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace ehdjet {

/// The field of distant charges at the inner beads. It is known at two times and extrapolated
/// linearly (model 6.1).
class ExtrapolatedField final : public ForceTerm {
public:
  [[nodiscard]] std::string_view name() const override {
    return "field of distant charges";
  }
  void add_force(const Stage& stage, Vec3View force) override;

  void clear() { known_ = 0; }
  [[nodiscard]] bool is_known() const { return known_ > 0; }
  /// The present field at the inner beads, x, y, z: each (beads). If beads have been born at the
  /// nozzle since the last call, they get the past of the bead below them, shifted by the difference of
  /// the present values.
  void learn(double t, std::span<const double> field, std::size_t beads);
  /// Adds to all that is known the field of charges that belong to the distant ones from now on, at
  /// the first beads, x, y, z: each (beads); the other beads leave.
  void add_to_past(std::span<const double> field, std::size_t beads);
  /// What is known is of `beads` beads. errors : InputError if a checkpoint that is read says otherwise
  void archive_past(const Archive& a, std::size_t beads);

private:
  struct Known {
    double time = 0;           // [s]
    std::vector<double> field; // x, y, z: each (beads) [V/m]
  };

  std::size_t beads_ = 0, known_ = 0;
  std::array<Known, 2> past_; // the older one first
};

} // namespace ehdjet
