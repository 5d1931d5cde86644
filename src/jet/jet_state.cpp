#include "ehdjet/jet/jet_state.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

namespace ehdjet {
namespace {

void archive_columns(const Archive& a, JetState& jet) {
  const BeadTable& table = *jet.table;
  if (a.is_reading()) {
    const auto names = a.names();
    for (const std::string& name : names)
      if (!table.find_integrated(name) && !table.find_carried(name))
        throw InputError("the checkpoint has a column " + name
                         + ", which the scene does not have");
    for (const auto columns : {table.integrated(), table.carried()})
      for (const BeadColumn& c : columns)
        if (std::ranges::find(names, c.name) == names.end())
          throw InputError("the checkpoint has no column " + c.name
                           + ", which the scene has");
  }
  std::vector<double> y;
  bool equally_long = true;
  for (std::size_t c = 0; c < table.carried().size(); ++c)
    a(table.carried()[c].name, jet.carried(c));
  for (std::size_t c = 0; c < table.carried().size(); ++c)
    equally_long &= jet.carried(c).size() == jet.beads();
  for (std::size_t c = 0; c < table.carried().size(); ++c)
    a.require(table.carried()[c].name, all_finite(jet.carried(c)), "is not finite");
  a.require("mass", none_negative(jet.mass), "is negative");
  a.require("volume", none_negative(jet.volume), "is negative");
  for (std::size_t c = 0; c < table.integrated().size(); ++c) {
    std::vector<double> column;
    if (!a.is_reading())
      column.assign(jet.columns().column(c).begin(), jet.columns().column(c).end());
    a(table.integrated()[c].name, column);
    equally_long &= column.size() == jet.beads();
    a.require(table.integrated()[c].name, all_finite(column), "is not finite");
    y.insert(y.end(), column.begin(), column.end());
  }
  if (jet.beads() < 2 || !equally_long)
    throw InputError("the checkpoint is damaged: its columns have different lengths");
  jet.y = std::move(y);
}

auto at_offset(std::vector<double>& v, std::size_t i) {
  return v.begin() + static_cast<std::ptrdiff_t>(i);
}

} // namespace

bool JetState::is_landed(std::size_t bead) const {
  return std::ranges::any_of(landed,
                             [bead](const LandedBead& l) { return l.bead == bead; });
}

void archive(const Archive& a, JetState& jet) {
  a("time", jet.time), archive_columns(a.part("columns"), jet);
  a("has_embryo", jet.has_embryo), a("absorbing_plane", jet.absorbing_plane);
  a("fed_since", jet.fed_since), a("field_is_off", jet.field_is_off);
  archive(a.part("mat"), jet.mat);
  std::vector<double> bead, time, radius;
  for (const LandedBead& l : jet.landed) {
    bead.push_back(static_cast<double>(l.bead));
    time.push_back(l.time), radius.push_back(l.radius);
  }
  a("landed_bead", bead), a("landed_time", time), a("landed_radius", radius);
  if (!a.is_reading()) return;
  const auto whole = [&](double k) {
    return k == std::floor(k) && k >= 0 && k < static_cast<double>(jet.beads());
  };
  const auto is_past = [&](double t) { return t >= 0 && t <= jet.time; };
  a.require("time", std::isfinite(jet.time) && jet.time >= 0, "is no time of a run");
  a.require("has_embryo", jet.beads() > jet.first(), "needs more beads");
  a.require("absorbing_plane", std::isfinite(jet.absorbing_plane.value_or(0)),
            "is not finite");
  a.require("fed_since", is_past(jet.fed_since), "is not in the past");
  a.require("landed_bead", std::ranges::all_of(bead, whole), "is no bead of the chain");
  a.require("landed_bead",
            std::ranges::adjacent_find(bead, std::greater_equal{}) == bead.end(),
            "is not in order");
  a.require("landed_time", time.size() == bead.size(), "has another length");
  a.require("landed_time", std::ranges::all_of(time, is_past), "is not in the past");
  a.require("landed_radius", radius.size() == bead.size(), "has another length");
  a.require("landed_radius", none_negative(radius), "is negative");
  jet.landed.clear();
  for (std::size_t i = 0; i < bead.size(); ++i)
    jet.landed.push_back({static_cast<std::size_t>(bead[i]), time[i], radius[i]});
}

JetState blank_jet(std::shared_ptr<const BeadTable> table, std::size_t beads) {
  JetState jet;
  jet.table = std::move(table);
  jet.y.resize(jet.table->integrated().size() * beads);
  jet.declared.resize(jet.table->carried().size() - BeadTable::basic_carried);
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c)
    jet.carried(c).resize(beads);
  return jet;
}

JetState blank_like(const JetState& jet, std::size_t beads) {
  JetState blank = blank_jet(jet.table, beads);
  blank.time = jet.time, blank.has_embryo = jet.has_embryo;
  blank.field_is_off = jet.field_is_off, blank.mat = jet.mat;
  blank.fed_since = jet.fed_since, blank.absorbing_plane = jet.absorbing_plane;
  return blank;
}

void insert_bead(JetState& jet, std::size_t at, const Bead& bead) {
  const std::size_t n = jet.beads();
  EHDJET_EXPECTS(at <= n);
  const std::size_t columns = jet.table->integrated().size();
  EHDJET_EXPECTS(jet.y.size() == columns * n);
  const auto values = column_values(bead, *jet.table);

  // Column c moves up by c places below `at` and by c + 1 above it; the last column first, so
  // that nothing is overwritten before it has moved.
  jet.y.resize(columns * (n + 1));
  for (std::size_t c = columns; c-- > 0;) {
    const auto column = at_offset(jet.y, c * n);
    const auto split = column + static_cast<std::ptrdiff_t>(at);
    const auto end = column + static_cast<std::ptrdiff_t>(n);
    const auto moved = static_cast<std::ptrdiff_t>(c);
    std::move_backward(split, end, end + moved + 1);
    if (moved > 0) std::move_backward(column, split, split + moved);
    *(split + moved) = values[c];
  }
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c)
    jet.carried(c).insert(at_offset(jet.carried(c), at), values[columns + c]);
  for (LandedBead& l : jet.landed)
    if (l.bead >= at) ++l.bead;
}

void remove_leading_bead(JetState& jet) {
  const std::size_t n = jet.beads();
  EHDJET_EXPECTS(n > 1);
  const std::size_t columns = jet.table->integrated().size();
  EHDJET_EXPECTS(jet.y.size() == columns * n);
  for (std::size_t c = 1; c < columns; ++c) {
    const auto column = at_offset(jet.y, c * n);
    std::move(column, column + static_cast<std::ptrdiff_t>(n - 1),
              at_offset(jet.y, c * (n - 1)));
  }
  jet.y.resize(columns * (n - 1));
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c) jet.carried(c).pop_back();
  if (!jet.landed.empty() && jet.landed.back().bead == n - 1) jet.landed.pop_back();
}

std::vector<double> column_values(const Bead& bead, const BeadTable& table) {
  const auto integrated = table.integrated().subspan(BeadTable::basic_integrated);
  const auto carried = table.carried().subspan(BeadTable::basic_carried);
  EHDJET_EXPECTS(bead.declared.empty()
                 || bead.declared.size() == integrated.size() + carried.size());
  std::vector<double> values{bead.position.x(), bead.position.y(), bead.position.z(),
                             bead.velocity.x(), bead.velocity.y(), bead.velocity.z()};
  std::size_t next = 0;
  const auto append = [&](std::span<const BeadColumn> columns) {
    for (const BeadColumn& c : columns)
      values.push_back(bead.declared.empty() ? c.at_birth : bead.declared[next++]);
  };
  append(integrated);
  values.insert(values.end(), {bead.volume, bead.mass, bead.charge});
  append(carried);
  return values;
}

Bead bead_at(const JetState& jet, std::size_t bead) {
  const auto columns = jet.columns();
  Bead b{.position = columns.position()[bead],
         .velocity = columns.velocity()[bead],
         .volume = jet.volume[bead],
         .mass = jet.mass[bead],
         .charge = jet.charge[bead]};
  const BeadTable& table = *jet.table;
  for (std::size_t c = BeadTable::basic_integrated; c < table.integrated().size(); ++c)
    b.declared.push_back(columns.column(c)[bead]);
  for (std::size_t c = BeadTable::basic_carried; c < table.carried().size(); ++c)
    b.declared.push_back(jet.carried(c)[bead]);
  return b;
}

double link_volume(const JetState& jet, std::size_t bead) {
  return link_volume(jet, jet.columns(), bead);
}

double link_volume(const JetState& jet, JetColumns<const double> state, std::size_t bead) {
  const auto& drying = jet.table->drying();
  if (!drying) return jet.volume[bead];
  return jet.volume[bead] * (1 - state.column(drying->column)[bead]);
}

double link_mass(const JetState& jet, std::size_t bead) {
  const auto& drying = jet.table->drying();
  if (!drying) return jet.mass[bead];
  return jet.mass[bead] * (1 - drying->mass * jet.columns().column(drying->column)[bead]);
}

double link_length(const JetState& jet, std::size_t bead) {
  EHDJET_EXPECTS(bead >= 1 && bead < jet.beads());
  return link_length(jet.columns().position(), jet.first(), bead);
}

double link_length(ConstVec3View r, std::size_t first, std::size_t bead) {
  return (r[bead] - r[bead <= first ? 0 : bead - 1]).norm();
}

double link_radius(double volume, double length) {
  return std::sqrt(volume / (std::numbers::pi * length));
}

} // namespace ehdjet
