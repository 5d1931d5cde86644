#include "ehdjet/core/constants.hpp"
#include "ehdjet/io/export.hpp"

#include <array>
#include <string_view>

namespace ehdjet {
namespace {

/// A column of JETSPIN's statistics: an observable in other units.
struct StatisticsColumn {
  std::string_view heading, observable;
  double factor = 1; ///< from SI units
  double less = 0;   ///< is taken away before
};

constexpr double cm = 100, per_ampere = constants::statcoulomb_per_coulomb;
constexpr std::array<StatisticsColumn, 11> columns{
    {{"t (s)", "time"},
     {"x (cm)", "tip_x", cm},
     {"yz (cm)", "tip_yz", cm},
     {"n", "beads", 1, 1}, // JETSPIN leaves out bead 0
     {"angl (deg)", "aperture"},
     {"lp (cm)", "path_length", cm},
     {"vn (cm s^-1)", "nozzle_speed", cm},
     {"vc (cm s^-1)", "impact_speed", cm},
     {"rc (cm)", "collector_radius", cm},
     {"curn (statC s^-1)", "current_in", per_ampere},
     {"curc (statC s^-1)", "current_out", per_ampere}}};

} // namespace

void export_jetspin_statistics(const RunReader& run, TextOutput& output) {
  const RunTable table = run.table("observables");
  const std::vector<double>& steps = table["steps"];
  std::array<const std::vector<double>*, columns.size()> values{};
  for (std::size_t c = 0; c < columns.size(); ++c)
    values[c] = &table[columns[c].observable];
  output.print("#{:>9}", "nstep");
  for (const StatisticsColumn& c : columns) output.print("{:>20}", c.heading);
  output.print("\n");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    output.print("{:>10}", steps[row]);
    for (std::size_t c = 0; c < columns.size(); ++c)
      output.print("{:>20.10g}", ((*values[c])[row] - columns[c].less) * columns[c].factor);
    output.print("\n");
  }
  output.close();
}

} // namespace ehdjet
