#include "ehdjet/jet/jet_state.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace ehdjet {
namespace {

constexpr std::size_t max_columns = JetColumns<double>::kinematic_columns + 1;

std::array<double, max_columns> column_values(const Bead& b) {
  return {b.position.x(), b.position.y(), b.position.z(), b.velocity.x(),
          b.velocity.y(), b.velocity.z(), b.stress};
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
  a("time", jet.time), a("y", jet.y);
  a("mass", jet.mass), a("charge", jet.charge), a("volume", jet.volume);
  a("has_embryo", jet.has_embryo), a("absorbing_plane", jet.absorbing_plane);
  std::vector<double> bead, time, radius;
  for (const LandedBead& l : jet.landed) {
    bead.push_back(static_cast<double>(l.bead));
    time.push_back(l.time), radius.push_back(l.radius);
  }
  a("landed_bead", bead), a("landed_time", time), a("landed_radius", radius);
  if (!a.is_reading()) return;
  const std::size_t n = jet.beads(), landed = bead.size();
  if (n < 2 || jet.y.size() % n != 0 || jet.charge.size() != n || jet.volume.size() != n
      || time.size() != landed || radius.size() != landed)
    throw InputError("the checkpoint is damaged: its columns have different lengths");
  jet.landed.clear();
  for (std::size_t i = 0; i < landed; ++i)
    jet.landed.push_back({static_cast<std::size_t>(bead[i]), time[i], radius[i]});
}

void insert_bead(JetState& jet, std::size_t at, const Bead& bead) {
  const std::size_t n = jet.beads();
  EHDJET_EXPECTS(n > 0 && at <= n);
  const std::size_t columns = jet.y.size() / n;
  const auto values = column_values(bead);

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
  jet.mass.insert(at_offset(jet.mass, at), bead.mass);
  jet.charge.insert(at_offset(jet.charge, at), bead.charge);
  jet.volume.insert(at_offset(jet.volume, at), bead.volume);
  for (LandedBead& l : jet.landed)
    if (l.bead >= at) ++l.bead;
}

void remove_leading_bead(JetState& jet) {
  const std::size_t n = jet.beads();
  EHDJET_EXPECTS(n > 1);
  const std::size_t columns = jet.y.size() / n;
  for (std::size_t c = 1; c < columns; ++c) {
    const auto column = at_offset(jet.y, c * n);
    std::move(column, column + static_cast<std::ptrdiff_t>(n - 1),
              at_offset(jet.y, c * (n - 1)));
  }
  jet.y.resize(columns * (n - 1));
  jet.mass.pop_back(), jet.charge.pop_back(), jet.volume.pop_back();
  if (!jet.landed.empty() && jet.landed.back().bead == n - 1) jet.landed.pop_back();
}

Bead bead_at(const JetState& jet, std::size_t bead) {
  const auto c = jet.columns();
  return {.position = c.position()[bead],
          .velocity = c.velocity()[bead],
          .stress = c.has_stress() ? c.stress()[bead] : 0.0,
          .volume = jet.volume[bead],
          .mass = jet.mass[bead],
          .charge = jet.charge[bead]};
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
