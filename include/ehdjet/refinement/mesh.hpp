#pragma once

#include "ehdjet/refinement/jet_string.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace ehdjet {

/// A mesh whose first knots are kept.
struct Mesh {
  std::size_t kept = 0; ///< s: knots 0 ... s stay as they are
  std::vector<double>
      arc_length; ///< of the new knots behind s; the last is the string's end [m]
};

/// The mesh that a string needs (model 7): from knot s on, the first one at or behind
/// `first_knot` whose downstream link is longer than `length` (L~) [m], n_ref = ceil(S/L~) links
/// of equal arc length. Nothing if no link is too long or if the number of links would not grow.
/// errors : RunError for more than ten million links
std::optional<Mesh> plan_mesh(const JetString& string, std::size_t first_knot,
                              double length);

} // namespace ehdjet
