#pragma once

#include "ehdjet/jet/jet_state.hpp"

#include <memory>
#include <span>

/// The stress of a viscoelastic fluid in jets whose table has no other declared column.
namespace ehdjet::test {

/// The table of such a jet, as the Maxwell fluid makes it.
inline std::shared_ptr<const BeadTable>
table_with_stress(ColumnRemap velocity = ColumnRemap::spline,
                  ColumnRemap stress = ColumnRemap::spline) {
  auto table = std::make_shared<BeadTable>();
  table->declare(
      {.name = "stress", .unit = "Pa", .description = "of that link", .weight = "volume"});
  for (const char* name : {"vx", "vy", "vz"}) table->set_remap(name, velocity);
  table->set_remap("stress", stress);
  return table;
}

template <class T>
std::span<T> stress_of(const JetColumns<T>& columns) {
  return columns.column(BeadTable::basic_integrated);
}
template <class T>
bool has_stress(const JetColumns<T>& columns) {
  return columns.count() > BeadTable::basic_integrated;
}
inline double stress_of(const Bead& bead) {
  return bead.declared.empty() ? 0 : bead.declared.front();
}

} // namespace ehdjet::test
