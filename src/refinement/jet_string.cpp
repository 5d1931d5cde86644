#include "ehdjet/refinement/jet_string.hpp"

#include "ehdjet/core/error.hpp"

#include <fmt/format.h>

namespace ehdjet {

JetString::JetString(const JetState& jet)
    : skips_embryo(jet.has_embryo) {
  const auto r = jet.columns().position();
  const std::size_t knots = jet.beads() - (skips_embryo ? 1 : 0);
  arc_length.reserve(knots);
  arc_length.push_back(0);
  for (std::size_t i = 1; i < knots; ++i) {
    const double next = arc_length.back() + (r[bead(i)] - r[bead(i - 1)]).norm();
    if (!(next > arc_length.back()))
      throw RunError(fmt::format(
          "refinement at t = {:.9g} s: bead {} coincides with bead {} or is nowhere: no "
          "curve goes through them",
          jet.time, bead(i), bead(i - 1)));
    arc_length.push_back(next);
  }
}

std::vector<double> JetString::at_knots(std::span<const double> column) const {
  std::vector<double> values(column.begin(), column.end());
  if (skips_embryo) values.erase(values.begin() + 1);
  return values;
}

} // namespace ehdjet
