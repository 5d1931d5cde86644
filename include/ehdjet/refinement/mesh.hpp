#pragma once

#include "ehdjet/refinement/jet_string.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace ehdjet {

/// What makes the mesh finer than elsewhere.
enum class MeshWeight {
  uniform,   ///< nothing: equal links
  curvature, ///< of the string at the beads
  radius,    ///< of the links: thick parts, where a varicose bump is
  stress     ///< magnitude, of the links
};

/// How a string is to be cut into links.
struct MeshRule {
  double length =
      0; ///< L~: links longer than this are cut; the mean link of a weighted mesh [m]
  MeshWeight weight = MeshWeight::uniform;
  /// Of a weighted mesh: there are 1 + strength phi/<phi> links where there would be one if phi,
  /// the observable, were zero [-].
  double strength = 1;
  double shortest = 0;                                      ///< of a weighted mesh [m]
  double longest = std::numeric_limits<double>::infinity(); ///< of a weighted mesh [m]
  std::size_t most_links = std::numeric_limits<std::size_t>::max(); ///< of the whole jet
  std::size_t refused_above =
      10'000'000; ///< links that are a slip, and gigabytes of memory
};

/// A mesh whose first knots are kept.
struct Mesh {
  std::size_t kept = 0; ///< s: knots 0 ... s stay as they are
  std::vector<double>
      arc_length; ///< of the new knots behind s; the last is the string's end [m]
};

/// The mesh that a string needs (model 7): from knot s on, the first one at or behind
/// `first_knot` whose downstream link is too long, n_ref = ceil(S/L~) links of equal (weighted)
/// arc length. Nothing if no link is too long or if that would not increase the number of
/// links.
/// errors : RunError for more links than are not refused
std::optional<Mesh> plan_mesh(const JetString& string, const JetState& jet,
                              std::size_t first_knot, const MeshRule& rule);

} // namespace ehdjet
