#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <vector>

namespace ehdjet {
namespace {

// Bead k disappears; bead k+1 gets its link and takes over what it carried. Momentum and V sigma
// are kept.
void join_with_next(JetState& jet, std::size_t k) {
  const auto c = jet.columns();
  const double mass = jet.mass[k] + jet.mass[k + 1];
  const double volume = jet.volume[k] + jet.volume[k + 1];
  c.velocity().set(k + 1,
                   (jet.mass[k] * c.velocity()[k] + jet.mass[k + 1] * c.velocity()[k + 1])
                       / mass);
  if (c.has_stress())
    c.stress()[k + 1] =
        (jet.volume[k] * c.stress()[k] + jet.volume[k + 1] * c.stress()[k + 1]) / volume;
  jet.mass[k + 1] = mass, jet.volume[k + 1] = volume;
  jet.charge[k + 1] += jet.charge[k];
}

void remove_beads(JetState& jet, const std::vector<bool>& gone) {
  const std::size_t beads = jet.beads(), columns = jet.y.size() / beads;
  std::vector<std::size_t> place(beads); // of each bead among those that stay
  std::size_t stay = 0;
  for (std::size_t k = 0; k < beads; ++k) {
    place[k] = stay;
    if (!gone[k]) ++stay;
  }
  const auto close_up = [&](const double* from, double* to) {
    for (std::size_t k = 0; k < beads; ++k)
      if (!gone[k]) to[place[k]] = from[k];
  };
  for (std::size_t c = 0; c < columns; ++c)
    close_up(jet.y.data() + c * beads, jet.y.data() + c * stay);
  jet.y.resize(columns * stay);
  for (auto* column : {&jet.mass, &jet.charge, &jet.volume}) {
    close_up(column->data(), column->data());
    column->resize(stay);
  }
  for (LandedBead& b : jet.landed) b.bead = place[b.bead];
}

} // namespace

std::optional<MeshChange> coarsen_jet(JetState& jet, const RefinementRule& rule) {
  EHDJET_EXPECTS(rule.coarsen);
  const std::size_t before = jet.links();
  std::vector<bool> gone(jet.beads(), false);
  std::optional<MeshChange> change;
  const auto r = jet.columns().position();
  // The first link is being fed and its bead triggers the next insertion.
  const std::size_t fed = rule.has_nozzle ? jet.first() : 0;
  for (std::size_t k = fed + 1; k + 1 < jet.beads(); ++k) {
    const double both = (r[k] - r[k - 1]).norm() + (r[k + 1] - r[k]).norm();
    if (both > *rule.coarsen || jet.is_landed(k) || jet.is_landed(k + 1)) continue;
    join_with_next(jet, k);
    gone[k] = true;
    if (!change) change = MeshChange{.kept = k - 1, .before = before, .after = 0};
    ++k; // pairs only: what is still too short is joined next time
  }
  if (!change) return std::nullopt;
  remove_beads(jet, gone);
  change->after = jet.links();
  return change;
}

} // namespace ehdjet
