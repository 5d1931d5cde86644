#pragma once

#include "ehdjet/run_files/run_reader.hpp"

#include <cstddef>

#include "panel.hpp"

namespace ehdjet {

/// The deposit of a run, in the order of landing; one value per landed bead [SI].
struct DepositedFibre {
  Values removal_time, y, z, radius;
  Values length; ///< of the link of each bead; not finite where it has no radius
  Values jet;
  Values dry_radius{}; ///< empty: nothing dries

  explicit DepositedFibre(const RunReader& run);
  /// Number of beads that have landed until then.
  [[nodiscard]] std::size_t landed_by(double time) const;
  /// The first beads in the plane of the collector, each jet's fibre as a line of its own.
  [[nodiscard]] Curve on_collector(std::size_t beads, const char* colour) const;
  /// The radii but those of the thinnest and of the thickest hundredth of the length.
  [[nodiscard]] Range most_radii(const Values& radii) const;
};

/// Bins for the length of fibre by its radius, equally wide, in the logarithm if the radii differ by a factor of
/// four. The few thinner and thicker parts are in the outermost ones.
class RadiusBins {
public:
  static constexpr std::size_t number = 32;

  RadiusBins() = default;
  explicit RadiusBins(const Range& most);
  [[nodiscard]] const Range& radii() const { return radii_; }
  [[nodiscard]] bool logarithmic() const { return logarithmic_; }
  /// Radius between bin i - 1 and bin i [m].
  [[nodiscard]] double edge(std::size_t i) const;
  /// Length of the fibre of the first beads in each bin [m].
  [[nodiscard]] Values lengths(const DepositedFibre& fibre, const Values& radius,
                               std::size_t beads) const;

private:
  Range radii_;
  bool logarithmic_ = false;
};

} // namespace ehdjet
