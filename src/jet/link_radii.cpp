#include "ehdjet/jet/link_radii.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/jet/jet_state.hpp"

namespace ehdjet {

void link_radii(ConstVec3View r, std::size_t first, std::span<const double> volume,
                std::span<double> radius) {
  const std::size_t n = r.size();
  EHDJET_EXPECTS(volume.size() == n && radius.size() == n);
  for (std::size_t k = first; k < n; ++k)
    radius[k] = link_radius(volume[k], link_length(r, first, k));
  if (first == 2) // bead 1 is an embryo
    radius[1] = link_radius(volume[1], (r[1] - r[0]).norm());
  if (n > 0) radius[0] = first < n ? radius[first] : 0;
}

} // namespace ehdjet
