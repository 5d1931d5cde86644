#include "ehdjet/jet/ledger.hpp"

#include <cmath>

namespace ehdjet {

void archive(const Archive& a, Ledger& l) {
  a("inserted_beads", l.inserted_beads), a("removed_beads", l.removed_beads);
  a("inserted_mass", l.inserted_mass), a("removed_mass", l.removed_mass);
  a("inserted_charge", l.inserted_charge), a("removed_charge", l.removed_charge);
  a("inserted_volume", l.inserted_volume), a("removed_volume", l.removed_volume);
  a("release_speed", l.release_speed), a("impact_speed", l.impact_speed);
  a("collector_radius", l.collector_radius);
  a.require("release_speed", std::isfinite(l.release_speed), "is not finite");
  a.require("impact_speed", std::isfinite(l.impact_speed), "is not finite");
}

Ledger sum_of(std::span<const Ledger> ledgers) {
  Ledger sum;
  for (const Ledger& l : ledgers) {
    sum.inserted_beads += l.inserted_beads, sum.removed_beads += l.removed_beads;
    sum.inserted_mass += l.inserted_mass, sum.removed_mass += l.removed_mass;
    sum.inserted_charge += l.inserted_charge, sum.removed_charge += l.removed_charge;
    sum.inserted_volume += l.inserted_volume, sum.removed_volume += l.removed_volume;
  }
  for (double Ledger::*value :
       {&Ledger::release_speed, &Ledger::impact_speed, &Ledger::collector_radius}) {
    double jets = 0;
    for (const Ledger& l : ledgers)
      if (l.*value != 0) sum.*value += l.*value, ++jets;
    if (jets > 0) sum.*value /= jets;
  }
  return sum;
}

void archive(const Archive& a, RunStatistics& s) {
  a("evaluations", s.evaluations), a("steps", s.steps), a("rejected", s.rejected);
  a("insertions", s.insertions), a("releases", s.releases), a("landings", s.landings);
  a("refinements", s.refinements);
  if (s.two_rates) {
    TwoRateRecord& r = *s.two_rates;
    a("macro_steps", r.steps), a("inner_evaluations", r.inner_evaluations);
    a("inner_beads", r.inner_beads), a("full_sums", r.full_sums);
  }
  if (s.method) a("method_since", s.method->since), a("method_changes", s.method->changes);
  a("coulomb_error", s.coulomb_error), a("coulomb_violations", s.coulomb_violations);
  a("coincident_pairs", s.coincident_pairs);
  a("shortest_step", s.shortest_step), a("longest_step", s.longest_step);
  a("wall_time", s.wall_time);
  a.require("shortest_step", s.shortest_step > 0, "is not positive");
  a.require("longest_step", s.longest_step >= 0 && std::isfinite(s.longest_step),
            "is no length of a step");
  a.require("wall_time", s.wall_time >= 0 && std::isfinite(s.wall_time), "is no time");
}

} // namespace ehdjet
