#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>

namespace ehdjet {

/// `link_radius` of all links of a chain with these volumes. Bead 0 owns no link: it gets the radius of the first one,
/// with which a drawn jet begins. `radius` may be `volume`.
///
/// shapes : r, volume, radius (beads); `first` as JetState::first
/// units  : [m], [m^3]
void link_radii(ConstVec3View r, std::size_t first, std::span<const double> volume,
                std::span<double> radius);

} // namespace ehdjet
