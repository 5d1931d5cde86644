#pragma once

#include "ehdjet/jet/inflow.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/links.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ehdjet {

/// What a force term may look at during one evaluation of the right-hand side.
/// Derived quantities are pulled: what no term asks for is never computed.
class Stage {
public:
  double time = 0;                  ///< [s]
  JetColumns<const double> columns; ///< integrated columns at this stage
  std::span<const double> mass; ///< [kg], like charge and volume as they act at this stage
  std::span<const double> charge; ///< as it acts on other beads [C]
  /// Of the links: the charge of a landed bead's link remains, on a grounded collector too [C].
  std::span<const double> link_charge;
  std::span<const double> volume;                ///< [m^3]
  std::span<const std::vector<double>> declared; ///< further carried columns
  std::size_t first = 1;      ///< first bead below bead 0 with local forces
  const Feed* feed = nullptr; ///< what flows into link 1; null: nothing does
  bool field_is_off = false;  ///< of a field that is switched
  const Mat* mat = nullptr;   ///< charges that act and are no targets; null: there are none
  std::span<const LandedBead> landed;
  Vec3 plate_velocity = Vec3::Zero();  ///< of landed beads [m/s]
  std::span<const std::uint8_t> moves; ///< 1: the bead moves freely
  /// Beads that have passed the collector since the step began, and stand where they crossed; descending.
  std::span<const std::size_t> absorbed;
  /// Beads whose forces are asked for, and those whose charges act on them: all, unless only a part
  /// of the right-hand side is evaluated.
  BeadRange targets, sources;

  /// Call after the positions or the targets have changed.
  void invalidate() { links_ready_ = false; }

  [[nodiscard]] std::size_t beads() const { return mass.size(); }
  /// Carried column c of the table.
  [[nodiscard]] std::span<const double> carried(std::size_t c) const {
    const std::array named{volume, mass, charge};
    return c < named.size() ? named[c] : std::span(declared[c - named.size()]);
  }
  /// Geometry of the links at the targets: of those that end at a target and of the next one.
  [[nodiscard]] const Links& links() const {
    if (!links_ready_) { // never written to once they are: loops on all threads may ask
      links_.compute(columns.position(), first, targets);
      links_ready_ = true;
    }
    return links_;
  }

private:
  mutable Links links_; // reused: no allocation while the number of beads stays
  mutable bool links_ready_ = false;
};

} // namespace ehdjet
