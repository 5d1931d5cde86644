#pragma once

#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/scene/read_scene.hpp"

#include <cstddef>
#include <vector>

/// Jets of any number of beads, long rather than dense.
namespace ehdjet::validation {

/// A bending jet with a distant collector. It is a computed refined jet whose last turns are repeated
/// downstream by a screw motion along the axis. First the turns are made periodic: the change of
/// radius and velocity over one period is subtracted evenly along it, so that the coil keeps its
/// width. Links are as long as in the computed jet, hundreds of radii.
class LongJet {
public:
  /// The jet of Table 2 at 0.2 cm at that time [s].
  explicit LongJet(double time);

  /// A chain held at the nozzle in the jet's field; no bead is inserted or lands, and no link is cut.
  [[nodiscard]] Scene scene(std::size_t beads) const;

private:
  void find_turns();
  [[nodiscard]] Bead repeated(std::size_t bead) const;

  Scene scene_; // without its beads
  JetState jet_;
  std::size_t first_ = 0, last_ = 0; // beads: the turns lie between them
  std::vector<double> angle_;        // of all beads, without jumps [rad]
};

} // namespace ehdjet::validation
