#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ehdjet::detail {

/// Computes the close pairs, which the kernels leave out (pair_kernel.hpp), from the original
/// coordinates. A hash table of places finds them. Charges at one place act as one charge, so that
/// the cost is O(n) even if many charges have the same place.
class ClosePairs {
public:
  /// Adds the forces of close sources on the targets. `scale` is the factor of the kernels'
  /// coordinates. Returns the number of pairs of a source and a target at the same place.
  std::size_t add_forces(const PointCharges& sources, const PointCharges& targets,
                         double scale, Vec3View force);

private:
  /// A distinct place of sources and their total charge.
  struct Place {
    Vec3 r;
    double charge;
    std::uint32_t number, next; ///< number of sources; the next place in the same list
  };
  std::uint32_t& list_of(const std::array<double, 3>& cell);
  void collect_places(const PointCharges& sources, double scale);

  std::vector<Place> places_;
  std::vector<std::uint32_t> lists_; ///< the first place of each list
};

} // namespace ehdjet::detail
