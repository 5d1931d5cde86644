#pragma once

#include "ehdjet/jet/jet_state.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

/// The jet as a string: its beads as knots of a curve, with the arc length from bead 0 by chords.
/// An embryo is not a knot, because its place is prescribed (model 4.1).
///
/// shapes : arc_length (knots), arc_length[0] = 0                               [m]
struct JetString {
  std::vector<double> arc_length;
  bool skips_embryo = false;

  /// errors : RunError naming the bead if two successive beads coincide or a place is not a number
  explicit JetString(const JetState& jet);

  [[nodiscard]] std::size_t knots() const { return arc_length.size(); }
  [[nodiscard]] std::size_t bead(std::size_t knot) const {
    return skips_embryo && knot > 0 ? knot + 1 : knot;
  }
  [[nodiscard]] double length() const { return arc_length.back(); } ///< [m]
  /// Length of the link that ends at a knot > 0 [m].
  [[nodiscard]] double link(std::size_t knot) const {
    return arc_length[knot] - arc_length[knot - 1];
  }
  /// A per-bead column, knot by knot.
  [[nodiscard]] std::vector<double> at_knots(std::span<const double> column) const;
};

} // namespace ehdjet
