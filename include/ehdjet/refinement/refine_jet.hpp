#pragma once

#include "ehdjet/refinement/mesh.hpp"
#include "ehdjet/refinement/remap.hpp"

#include <cstddef>
#include <optional>

namespace ehdjet {

/// How volume, mass, charge and other amounts (ColumnRemap::share) get onto a new mesh.
enum class LinkRemap {
  conservative, ///< along the arc length, every sum and every bump kept (see Remap)
  paper ///< radius by spline, V = pi a^2 l, one factor that keeps the sum of V; the others in
        ///< proportion to V
};
struct RefinementRule {
  double length = 0; ///< L~: links longer than this are cut [m]
  LinkRemap remap = LinkRemap::conservative;
  /// Neighbouring links that are together no longer than this become one; absent: never [m].
  std::optional<double> coarsen;
  /// A link shorter than so many of its own radii becomes one with a neighbour: it is no thread any more;
  /// absent: never.
  std::optional<double> shortest = {};
  std::optional<double> collector; ///< h: new beads are not put beyond it [m]
  /// Bead 0 is the nozzle: the link that is being fed, which grows to 2 l_step, is left alone.
  bool has_nozzle = true;

  [[nodiscard]] bool joins() const { return coarsen || shortest; }
  [[nodiscard]] std::size_t first_knot() const { return has_nozzle ? 1 : 0; }
};

/// What a refinement did.
struct MeshChange {
  std::size_t kept = 0;   ///< bead s: beads 0 ... s are untouched, bit for bit
  std::size_t before = 0; ///< links of the chain
  std::size_t after = 0;
  /// max |l/l* - 1| over the new links, l* the arc length they were given along the old chords:
  /// the curve through the beads is a little longer (second order).
  double worst_link = 0;
};

/// Cuts the jet anew where its links have become too long (model 7). Each column gets onto the new
/// mesh as the jet's table says (ColumnRemap). A landed leading bead
/// stays the last bead of the new mesh, where and as it is; a new bead beyond the collector is
/// put on it. Interior beads that have landed before the leading one lose their record and land
/// anew. Nothing if no link is too long or the number of beads would not grow. Done twice, it
/// does nothing the second time on a straight jet; on a curved one, whose finer mesh is a little
/// longer, it may add a few beads once more.
std::optional<MeshChange> refine_jet(JetState& jet, const RefinementRule& rule);

/// Whether a link that may be cut is longer than L~.
[[nodiscard]] bool has_long_link(const JetState& jet, const RefinementRule& rule);

/// Cuts each link that is longer than L~ into ceil(l/L~) parts and leaves all other beads as they are,
/// bit for bit (model 7). New beads lie on Akima's curve through the neighbours, with a velocity from
/// the same spline. Amounts are shared out along the link with a section that is linear between those of
/// the neighbours, and so are columns of links, whose sum weighted with the volume is kept; equal parts
/// would make a staircase of the thickness, from which capillary necking grows. A new bead beyond the
/// collector is put on it. The link that is being fed is left alone. Nothing if no
/// link is too long.
/// errors : RunError for more than ten million links
std::optional<MeshChange> cut_links(JetState& jet, const RefinementRule& rule);

/// Whether there are links to join.
[[nodiscard]] bool has_short_links(const JetState& jet, const RefinementRule& rule);

/// Joins neighbouring links that are together no longer than `rule.coarsen` or one of which is shorter
/// than `rule.shortest` (model 7): amounts and
/// the sums of weight times column (momentum, V sigma) are kept. The insertion zone and a landed
/// bead are left alone. Nothing if there are no such links.
std::optional<MeshChange> coarsen_jet(JetState& jet, const RefinementRule& rule);

} // namespace ehdjet
