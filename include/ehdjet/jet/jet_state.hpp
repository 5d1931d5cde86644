#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/jet/bead_table.hpp"
#include "ehdjet/jet/jet_columns.hpp"
#include "ehdjet/jet/mat.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// A bead that has reached the collector while it is still part of the chain (model 5).
struct LandedBead {
  std::size_t bead = 0; ///< index in the chain
  double time = 0;      ///< of its landing [s]
  double radius = 0;    ///< of its link at its landing [m]
};

/// The jet: an ordered chain of beads. Bead 0 is the nozzle (or the first bead of a given
/// chain), bead n = beads() - 1 the leading bead. Bead k owns link k, which joins it to its
/// upstream neighbour: its volume, mass and charge, and what force terms declare (model 1).
///
/// shapes : every carried column (beads); y = [x|y|z|vx|vy|vz|declared ones] (columns * beads)
/// units  : SI
/// While `has_embryo`, bead 1 is an embryo: it lies on the segment from bead 0 to bead 2,
/// which are neighbours for every local force (model 4.1).
struct JetState {
  double time = 0;                                             ///< [s]
  std::shared_ptr<const BeadTable> table = BeadTable::basic(); ///< which columns there are
  std::vector<double> y;                     ///< what the integrator advances
  std::vector<double> mass;                  ///< as it left the nozzle [kg]
  std::vector<double> charge;                ///< [C], the full charge also for an embryo
  std::vector<double> volume;                ///< as it left the nozzle [m^3]
  std::vector<std::vector<double>> declared; ///< further carried columns
  bool has_embryo = false;
  double fed_since = 0;           ///< when link 1 was cut last, if the inflow feeds it [s]
  bool field_is_off = false;      ///< of a field that is switched (model 2.6)
  std::vector<LandedBead> landed; ///< still in the chain, ascending bead index
  std::shared_ptr<const Mat>
      mat; ///< charges of the fibre on an insulating collector, or none
  /// While beads land every few steps: the plane beyond which, during a step, a bead counts as
  /// resting where it crossed (model 5). None: each landing ends a step [m].
  std::optional<double> absorbing_plane;

  [[nodiscard]] std::size_t beads() const { return mass.size(); }
  [[nodiscard]] std::size_t links() const { return beads() - 1; }
  /// First bead below bead 0 that takes part in local forces: 2 behind an embryo, else 1.
  [[nodiscard]] std::size_t first() const { return has_embryo ? 2 : 1; }
  [[nodiscard]] bool is_landed(std::size_t bead) const;

  /// Carried column c of the table, the three that have names included.
  [[nodiscard]] std::vector<double>& carried(std::size_t c) {
    constexpr std::array named{&JetState::volume, &JetState::mass, &JetState::charge};
    return c < named.size() ? this->*named[c] : declared[c - named.size()];
  }
  [[nodiscard]] const std::vector<double>& carried(std::size_t c) const {
    return const_cast<JetState*>(this)->carried(c);
  }
  [[nodiscard]] JetColumns<double> columns() { return {y, beads()}; }
  [[nodiscard]] JetColumns<const double> columns() const { return {y, beads()}; }
};

/// Properties of one bead, in or out of a chain. SI units.
struct Bead {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
  double volume = 0, mass = 0, charge = 0;
  /// In the order of BeadTable::declared; empty: as at birth.
  std::vector<double> declared = {};
};

/// errors : InputError naming the column if a checkpoint has other columns than the jet
void archive(const Archive& a, JetState& jet);

/// A jet of that many beads whose columns are all zero.
[[nodiscard]] JetState blank_jet(std::shared_ptr<const BeadTable> table, std::size_t beads);

/// A blank jet with the time, the state of embryo, feed and field, the mat and the absorbing plane of another jet, without
/// its landed beads: a start for putting that jet on another mesh.
[[nodiscard]] JetState blank_like(const JetState& jet, std::size_t beads);

/// Inserts a bead so that it gets index `at`; later beads (and their landing records) move up.
void insert_bead(JetState& jet, std::size_t at, const Bead& bead);

/// Removes the leading bead.
void remove_leading_bead(JetState& jet);

[[nodiscard]] Bead bead_at(const JetState& jet, std::size_t bead);
/// All values of a bead: of the integrated, then of the carried columns.
[[nodiscard]] std::vector<double> column_values(const Bead& bead, const BeadTable& table);

/// What a link has: its volume [m^3] and mass [kg] less what has evaporated (model 2.2).
[[nodiscard]] double link_volume(const JetState& jet, std::size_t bead);
[[nodiscard]] double link_mass(const JetState& jet, std::size_t bead);
/// The same, of another state of that chain.
[[nodiscard]] double link_volume(const JetState& jet, JetColumns<const double> state,
                                 std::size_t bead);

/// l_k = |r_k - r_(k-1)|, where the upstream neighbour of the bead behind an embryo is bead 0 [m].
[[nodiscard]] double link_length(const JetState& jet, std::size_t bead);
/// The same, of other positions of that chain.
[[nodiscard]] double link_length(ConstVec3View r, std::size_t first, std::size_t bead);

/// a_k = sqrt(V_k / (pi l_k))                                            (model 1) [m]
[[nodiscard]] double link_radius(double volume, double length);

} // namespace ehdjet
