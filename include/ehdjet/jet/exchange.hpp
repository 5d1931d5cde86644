#pragma once

#include "ehdjet/core/columns.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ehdjet {

/// Energy and momentum that something brings into a jet, or brings in per second.
struct Flow {
  double energy = 0;            ///< [J] or [W]
  Vec3 momentum = Vec3::Zero(); ///< [kg m/s] or [N]
};

/// A way through which energy and momentum enter a jet or leave it, and the columns that it has in a
/// budget (model 8). Channels of one name are one channel. A column without a name is not written.
struct Channel {
  std::string name = {};
  std::string energy = {}, energy_meaning = {};     ///< a column of that name [J]
  std::string momentum = {}, momentum_meaning = {}; ///< columns <name>_x, _y, _z [kg m/s]
  bool loss = false;  ///< the energy column counts what leaves
  bool axial = false; ///< the momentum has an x component only

  /// Columns <name>_energy and <name>_momentum.
  static Channel named(const std::string& name) {
    return {.name = name,
            .energy = name + "_energy",
            .energy_meaning = "brought in so far by: " + name,
            .momentum = name + "_momentum",
            .momentum_meaning = "brought in so far by: " + name};
  }
};

/// What keeps a bead from moving freely, and so takes up the forces on it.
enum class Support : std::uint8_t {
  none,      ///< nothing: the bead moves freely
  inflow,    ///< bead 0 is the nozzle
  insertion, ///< the inflow leads the bead: an embryo
  collector, ///< the bead has landed
  clamp      ///< a held end of a given chain
};
inline constexpr std::size_t supports = 5;

/// Collects what a force term brings into the jet per second (model 8).
struct Exchange {
  std::span<const Support> support_of;  ///< (beads)
  std::array<Vec3, 2> led_velocity;     ///< dr/dt of beads 0 and 1 where they are led [m/s]
  Vec3 plate_velocity;                  ///< of landed beads [m/s]
  Flow own;                             ///< of the term's own channel
  std::array<Flow, supports> supported; ///< of the supports

  [[nodiscard]] Support support(std::size_t bead) const { return support_of[bead]; }
  [[nodiscard]] Flow& by_support_of(std::size_t bead) {
    return supported[static_cast<std::size_t>(support(bead))];
  }
  /// Of what feeds bead 1.
  [[nodiscard]] Flow& by_inflow() {
    const Support s =
        support(1) == Support::insertion ? Support::insertion : Support::inflow;
    return supported[static_cast<std::size_t>(s)];
  }
  /// dr/dt of a bead that does not move freely [m/s].
  [[nodiscard]] Vec3 led(std::size_t bead) const {
    const Support s = support(bead);
    if (s == Support::collector) return plate_velocity;
    return s == Support::inflow || s == Support::insertion ? led_velocity[bead]
                                                           : Vec3(Vec3::Zero());
  }
};

} // namespace ehdjet
