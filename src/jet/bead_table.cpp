#include "ehdjet/jet/bead_table.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <utility>

namespace ehdjet {
namespace {

std::optional<std::size_t> find(std::span<const BeadColumn> columns,
                                std::string_view name) {
  const auto found = std::ranges::find(columns, name, &BeadColumn::name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

[[noreturn]] void refuse(const BeadColumn& column, const char* why) {
  throw ContractViolation("column " + column.name + " " + why);
}

} // namespace

BeadTable::BeadTable() {
  for (const char* name : {"volume", "mass", "charge"})
    declare({.name = name,
             .unit = name[0] == 'v'   ? "m^3"
                     : name[0] == 'm' ? "kg"
                                      : "C",
             .description = "of that link",
             .evolution = Evolution::carried,
             .remap = ColumnRemap::share});
  for (const char* name : {"x", "y", "z"})
    declare({.name = name,
             .unit = "m",
             .description = name[0] == 'x' ? "position along the axis, from the nozzle"
                                           : "position across the axis",
             .owner = Owner::bead});
  for (const char* name : {"vx", "vy", "vz"})
    declare({.name = name,
             .unit = "m/s",
             .description = "velocity",
             .owner = Owner::bead,
             .weight = "mass"});
}

std::shared_ptr<const BeadTable> BeadTable::basic() {
  static const auto table = std::make_shared<const BeadTable>();
  return table;
}

void BeadTable::declare(BeadColumn column) {
  const bool carried = column.evolution == Evolution::carried;
  if (find_integrated(column.name) || find_carried(column.name))
    refuse(column, "is declared twice");
  if (!column.weight.empty() && (carried || !find_carried(column.weight)))
    refuse(column, "has a weight that is no carried column declared before it");
  const bool of_carried =
      column.remap == ColumnRemap::share || column.remap == ColumnRemap::label;
  if (of_carried != carried
      || (column.remap == ColumnRemap::conservative && column.weight.empty()))
    refuse(column, "has a remap that does not suit its evolution or needs a weight");
  if (column.drying) {
    if (carried || column.owner != Owner::link || drying_)
      refuse(column, "cannot say what evaporates");
    drying_ = DryingColumn{*column.drying, integrated_.size()};
  }
  (carried ? carried_ : integrated_).push_back(std::move(column));
}

void BeadTable::set_remap(std::string_view name, ColumnRemap remap) {
  at(name).remap = remap;
}
void BeadTable::set_error_scale(std::string_view name, double scale) {
  at(name).error_scale = scale;
}

std::vector<BeadColumn> BeadTable::declared() const {
  std::vector<BeadColumn> columns(integrated_.begin() + basic_integrated,
                                  integrated_.end());
  columns.insert(columns.end(), carried_.begin() + basic_carried, carried_.end());
  return columns;
}

std::optional<std::size_t> BeadTable::find_integrated(std::string_view name) const {
  return find(integrated_, name);
}
std::optional<std::size_t> BeadTable::find_carried(std::string_view name) const {
  return find(carried_, name);
}

std::optional<std::size_t> BeadTable::weight_of(std::size_t integrated) const {
  return find_carried(integrated_[integrated].weight);
}

BeadColumn& BeadTable::at(std::string_view name) {
  if (const auto c = find_integrated(name)) return integrated_[*c];
  const auto c = find_carried(name);
  EHDJET_EXPECTS(c);
  return carried_[*c];
}

} // namespace ehdjet
