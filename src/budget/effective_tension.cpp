#include "ehdjet/budget/effective_tension.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <limits>

namespace ehdjet {

EffectiveTension::EffectiveTension(const JetDynamics& dynamics)
    : dynamics_(dynamics) {
  chain_.constrain(dynamics.constraints());
}

EffectiveTension::Summary EffectiveTension::of(const JetState& jet) {
  chain_.bind(jet);
  const Stage& stage = chain_.at(jet.time, jet.y);
  tension_.assign(jet.beads(), 0.0);
  for (const auto& term : dynamics_.terms()) term->add_tension(stage, tension_);

  const Links& links = stage.links();
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Summary s{.unstable_links = 0, .smallest = unknown, .shortest_in_radii = unknown};
  for (std::size_t k = links.first; k <= links.last; ++k) {
    s.unstable_links += tension_[k] < 0 ? 1 : 0;
    s.smallest = std::min(s.smallest, tension_[k]);
    const double l = links.length[k];
    s.shortest_in_radii =
        std::min(s.shortest_in_radii, l / link_radius(stage.volume[k], l));
  }
  s.unstable_links /= static_cast<double>(links.last + 1 - links.first);
  return s;
}

std::span<const Accounts::Column> EffectiveTension::columns() const {
  static const std::array<Column, 3> columns{
      {{"unstable_links", "1", "share of the links whose effective tension is negative"},
       {"smallest_tension", "N", "smallest effective tension of a link"},
       {"shortest_link_in_radii", "1", "smallest length of a link over its radius"}}};
  return columns;
}

void EffectiveTension::measure(const JetSnapshot& snapshot, std::span<double> row) {
  JetState jet = snapshot.jet;
  jet.time = snapshot.time;
  jet.y.assign(snapshot.columns.flat.begin(), snapshot.columns.flat.end());
  const Summary s = of(jet);
  EHDJET_EXPECTS(row.size() == columns().size());
  row[0] = s.unstable_links, row[1] = s.smallest, row[2] = s.shortest_in_radii;
}

} // namespace ehdjet
