#pragma once

#include "ehdjet/core/columns.hpp"

namespace ehdjet {

/// The collector: the plane x = distance, which may move along itself (model 5.1).
struct Plate {
  double distance = 0;          ///< h [m]
  Vec3 velocity = Vec3::Zero(); ///< U, x component 0 [m/s]

  [[nodiscard]] bool moves() const { return velocity != Vec3::Zero(); }
  /// A place in the coordinates that are fixed to the plate and coincide with the laboratory's at
  /// t = 0: r - U t [m].
  [[nodiscard]] Vec3 fixed(const Vec3& r, double t) const { return r - t * velocity; }
};

} // namespace ehdjet
