#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ehdjet {
namespace {

// Bead k disappears; bead k+1 gets its link and takes over what it carried.
void join_with_next(JetState& jet, std::size_t k) {
  const BeadTable& table = *jet.table;
  for (std::size_t c = 0; c < table.integrated().size(); ++c)
    if (const auto weight = table.weight_of(c)) {
      const auto column = jet.columns().column(c);
      const auto& w = jet.carried(*weight);
      column[k + 1] = (w[k] * column[k] + w[k + 1] * column[k + 1]) / (w[k] + w[k + 1]);
    }
  for (std::size_t c = 0; c < table.carried().size(); ++c)
    if (table.carried()[c].remap == ColumnRemap::share)
      jet.carried(c)[k + 1] += jet.carried(c)[k];
}

bool is_stub(const JetState& jet, const RefinementRule& rule, std::size_t k,
             double length) {
  return rule.shortest
         && length < *rule.shortest * link_radius(link_volume(jet, k), length);
}

// Whether links k and k + 1 would be one that is cut into stubs at once, which would be joined again for ever.
bool would_be_cut_into_stubs(const JetState& jet, const RefinementRule& rule,
                             std::size_t k) {
  const auto r = jet.columns().position();
  const double both = (r[k + 1] - r[k - 1]).norm();
  const double part = both / std::max(std::ceil(both / rule.length), 1.0);
  const double radius = link_radius(link_volume(jet, k) + link_volume(jet, k + 1), both);
  return part < both && part < *rule.shortest * radius;
}

// Whether links k and k + 1 are to become one.
bool joins_next(const JetState& jet, const RefinementRule& rule, std::size_t k) {
  if (jet.is_landed(k) || jet.is_landed(k + 1)) return false;
  const auto r = jet.columns().position();
  const double own = (r[k] - r[k - 1]).norm(), next = (r[k + 1] - r[k]).norm();
  if (rule.coarsen && own + next <= *rule.coarsen) return true;
  return (is_stub(jet, rule, k, own) || is_stub(jet, rule, k + 1, next))
         && !would_be_cut_into_stubs(jet, rule, k);
}

// The first link is being fed and its bead triggers the next insertion.
std::size_t first_to_join(const JetState& jet, const RefinementRule& rule) {
  return (rule.has_nozzle ? jet.first() : 0) + 1;
}

void remove_beads(JetState& jet, const std::vector<bool>& gone) {
  const std::size_t beads = jet.beads(), columns = jet.table->integrated().size();
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
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c) {
    close_up(jet.carried(c).data(), jet.carried(c).data());
    jet.carried(c).resize(stay);
  }
  for (LandedBead& b : jet.landed) b.bead = place[b.bead];
}

} // namespace

bool has_short_links(const JetState& jet, const RefinementRule& rule) {
  if (!rule.joins()) return false;
  for (std::size_t k = first_to_join(jet, rule); k + 1 < jet.beads(); ++k)
    if (joins_next(jet, rule, k)) return true;
  return false;
}

std::optional<MeshChange> coarsen_jet(JetState& jet, const RefinementRule& rule) {
  EHDJET_EXPECTS(rule.joins());
  const std::size_t before = jet.links();
  std::vector<bool> gone(jet.beads(), false);
  std::optional<MeshChange> change;
  for (std::size_t k = first_to_join(jet, rule); k + 1 < jet.beads(); ++k) {
    if (!joins_next(jet, rule, k)) continue;
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
