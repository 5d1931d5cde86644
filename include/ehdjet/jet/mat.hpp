#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

/// Charges on an insulating collector. They act on the jet and do not move, in the coordinates that are
/// fixed to the plate (Plate::fixed).
///
/// shapes : every array (charges)          units : [m], [C]
struct MatCharges {
  std::vector<double> x, y, z, charge; ///< charges as they are at `time`
  double time = 0;                     ///< when the last one was added [s]

  [[nodiscard]] std::size_t size() const { return charge.size(); }
  [[nodiscard]] ConstVec3View place() const { return {x, y, z}; }
  /// exp(-(t - time)/tau): the share of `charge` that is left at time t; 1 without a decay time [s].
  [[nodiscard]] double remaining(double t, const std::optional<double>& decay_time) const;
};

/// The charges of the fibre on an insulating collector (model 5.2). A mat is never changed, so that
/// copies of a jet share it; the one with a charge more shares the settled charges, so that solvers
/// know them again.
struct Mat {
  std::shared_ptr<const MatCharges> settled; ///< null before the first `block` charges
  MatCharges recent;                         ///< fewer than `block`
  static constexpr std::size_t block = 64;

  [[nodiscard]] std::size_t size() const {
    return (settled ? settled->size() : 0) + recent.size();
  }
  /// For each part that has charges.
  template <class Do>
  void for_each_part(const Do& part) const {
    if (settled) part(*settled);
    if (recent.size() > 0) part(recent);
  }
};

/// A mat with one more charge, which is added at time t at `place` [m], [C], [s]. All charges decay at
/// the same rate, so that one time is enough for each part.
///
/// cost   : O(block), and O(charges) for one of `block` calls
[[nodiscard]] std::shared_ptr<const Mat>
with_charge(const std::shared_ptr<const Mat>& mat, const Vec3& place, double charge,
            double t, const std::optional<double>& decay_time);

/// A jet without a mat has no lists of it.
void archive(const Archive& a, std::shared_ptr<const Mat>& mat);

} // namespace ehdjet
