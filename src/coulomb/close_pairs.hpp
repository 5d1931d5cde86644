#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ehdjet::detail {

/// The pairs that the kernels leave out because they are close (pair_kernel.hpp), computed from the
/// original coordinates. A hash table of places finds them: the cost is O(n), also where many
/// charges have one place, because charges of one place act as one.
class ClosePairs {
public:
  /// Forces of close sources on the targets, `scale` the factor of the kernels' coordinates.
  /// Returns the number of pairs of a source and a target at the same place.
  std::size_t add_forces(const PointCharges& sources, const PointCharges& targets,
                         double scale, Vec3View force);

private:
  /// Distinct places of sources, and what is there.
  struct Place {
    Vec3 r;
    double charge;
    std::uint32_t number, next; ///< of sources; the place that follows in the same list
  };
  std::vector<Place> places_;
  std::vector<std::uint32_t> lists_; ///< first place of each
};

} // namespace ehdjet::detail
