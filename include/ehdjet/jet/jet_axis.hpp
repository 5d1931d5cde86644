#pragma once

namespace ehdjet {

/// Where the axis of a jet crosses the plane x = 0 of the nozzles, from the axis of their array.
struct JetAxis {
  double y = 0, z = 0; ///< [m]
};

} // namespace ehdjet
