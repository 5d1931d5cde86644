#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// What a column describes. Bead k owns link k, which joins it to its upstream neighbour. Bead 0
/// owns no link: entry 0 of a column of links plays no part.
enum class Owner { bead, link };

enum class Evolution {
  integrated, ///< by its rate; a part of the vector y that the integrator advances
  carried     ///< constant between events
};

/// How a column gets onto another mesh (model 7). Where links are joined, `share` adds, and a
/// column with a weight becomes the average with that weight; all others keep the value of the
/// bead that stays.
enum class ColumnRemap {
  spline,       ///< integrated: Akima spline over the arc length
  conservative, ///< integrated: weight times column along the arc length: its sum is kept, and
                ///< the sum of weight times column squared can only fall
  share,        ///< carried: an amount, shared out along the arc length: its sum is kept
  label         ///< carried: a new link has the value of the old link around its middle
};

/// What a link loses as its solvent evaporates. The column that has this says how much volume it has
/// lost, over its volume at the nozzle (model 2.2):
///
///     V = V_0 (1 - e),   m = m_0 (1 - mass e),   e from 0 to 1 - dry
struct Drying {
  double mass = 0; ///< rho_s/rho of the fluid at the nozzle [-]
  double dry = 0;  ///< what is left of the volume when all solvent has gone, over V_0 [-]
};

/// The name of that column, in files too.
inline constexpr const char* evaporated = "evaporated";

/// One property of beads or links, and all that those who move, store or write it need to know.
struct BeadColumn {
  std::string name, unit, description;
  Owner owner = Owner::link;
  Evolution evolution = Evolution::integrated;
  ColumnRemap remap = ColumnRemap::spline;
  /// Integrated: a carried column declared before whose values are positive, or none.
  std::string weight = {};
  /// Integrated: the error is measured against rtol (error_scale + |y|) (model 6), in `unit`.
  double error_scale = 1;
  double at_birth = 0;     ///< of a new bead at the nozzle
  double unless_given = 0; ///< of the beads of a chain whose file does not have it
  std::optional<Drying> drying = {}; ///< integrated, of links: what evaporates
  /// Integrated: the stress that one `unit` stands for; 0: the column is no stress [Pa].
  double stress_of_one = 0;
};

/// The columns of a jet: x, y, z, vx, vy, vz (integrated), volume, mass, charge (carried), and
/// those that force terms declare, in the order of their declaration.
///
/// A column is known by its place among the columns of its evolution: integrated column c is
/// y[c beads ... (c + 1) beads), carried column c is JetState::carried(c).
class BeadTable {
public:
  BeadTable();
  /// The table of a jet for which nothing is declared.
  static std::shared_ptr<const BeadTable> basic();

  /// errors : ContractViolation for a second column of that name, an unknown weight, or a remap
  ///          that does not suit the evolution
  void declare(BeadColumn column);
  /// What a scene may change; the column must exist.
  void set_remap(std::string_view name, ColumnRemap remap);
  void set_error_scale(std::string_view name, double scale);

  [[nodiscard]] std::span<const BeadColumn> integrated() const { return integrated_; }
  [[nodiscard]] std::span<const BeadColumn> carried() const { return carried_; }
  /// All columns that terms have declared: the integrated ones first, then the carried ones.
  [[nodiscard]] std::vector<BeadColumn> declared() const;
  [[nodiscard]] std::optional<std::size_t> find_integrated(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> find_carried(std::string_view name) const;
  /// The carried column that an integrated one is weighted with.
  [[nodiscard]] std::optional<std::size_t> weight_of(std::size_t integrated) const;

  /// The column that says how much a link has lost; none: links keep what they carry.
  struct DryingColumn : Drying {
    std::size_t column = 0; ///< integrated
  };
  [[nodiscard]] const std::optional<DryingColumn>& drying() const { return drying_; }

  static constexpr std::size_t basic_integrated = 6, basic_carried = 3;

private:
  [[nodiscard]] BeadColumn& at(std::string_view name);
  std::vector<BeadColumn> integrated_, carried_;
  std::optional<DryingColumn> drying_;
};

} // namespace ehdjet
