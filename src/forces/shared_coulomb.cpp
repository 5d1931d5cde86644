#include "ehdjet/forces/shared_coulomb.hpp"

#include "ehdjet/core/error.hpp"

namespace ehdjet {

void SharedCoulomb::add_force(const Stage& stage, Vec3View force) {
  EHDJET_EXPECTS(force_.size() == stage.beads());
  for (std::size_t k = stage.targets.begin; k < stage.targets.end; ++k)
    force.add(k, force_[k]);
}

} // namespace ehdjet
