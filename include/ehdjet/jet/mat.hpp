#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

/// The charges of the fibre on an insulating collector (model 5.2). They act on the jet and do not
/// move, in the coordinates that are fixed to the plate (Plate::fixed). A mat is never changed, so that
/// copies of a jet share it.
///
/// shapes : every array (charges)          units : [m], [C]
struct Mat {
  std::vector<double> x, y, z, charge; ///< charges as they are at `time`
  double time = 0;                     ///< when the last one was added [s]

  [[nodiscard]] std::size_t size() const { return charge.size(); }
  [[nodiscard]] ConstVec3View place() const { return {x, y, z}; }
  /// exp(-(t - time)/tau): the share of `charge` that is left at time t; 1 without a decay time [s].
  [[nodiscard]] double remaining(double t, const std::optional<double>& decay_time) const;
};

/// A mat with one more charge, which is added at time t at `place` [m], [C], [s]. All of a mat decay at
/// the same rate, so that one time is enough for all.
///
/// cost   : O(charges)
[[nodiscard]] std::shared_ptr<const Mat>
with_charge(const std::shared_ptr<const Mat>& mat, const Vec3& place, double charge,
            double t, const std::optional<double>& decay_time);

/// A jet without a mat has no lists of it.
void archive(const Archive& a, std::shared_ptr<const Mat>& mat);

} // namespace ehdjet
