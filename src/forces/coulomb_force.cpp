#include "ehdjet/forces/coulomb_force.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/coulomb/pair_sum.hpp"

#include <algorithm>

namespace ehdjet {

void CoulombForce::add_force(const Stage& stage, Vec3View force) {
  const std::size_t n = stage.beads();
  const PointCharges all{stage.columns.position(), stage.charge, stage.moves};
  if (stage.targets.covers(n) && stage.sources.covers(n)) {
    solver_->add_force(all, force);
    coincident_pairs_ =
        std::max<std::uint64_t>(coincident_pairs_, solver_->coincident_pairs());
    return;
  }
  const auto part = [](auto columns, BeadRange beads) {
    const auto of = [&](auto v) { return v.subspan(beads.begin, beads.end - beads.begin); };
    return decltype(columns){of(columns.x), of(columns.y), of(columns.z)};
  };
  const auto charges = [&](BeadRange b) {
    const std::size_t size = b.end - b.begin;
    return PointCharges{part(all.r, b), all.q.subspan(b.begin, size),
                        all.moves.empty() ? all.moves : all.moves.subspan(b.begin, size)};
  };
  if (stage.targets.within(n) == stage.sources.within(n)) {
    solver_->add_force(charges(stage.sources), part(force, stage.sources));
    coincident_pairs_ =
        std::max<std::uint64_t>(coincident_pairs_, solver_->coincident_pairs());
    return;
  }
  // A bead and itself is a pair at zero distance here: such pairs are not counted.
  solver_->add_force_from(charges(stage.sources), charges(stage.targets),
                          part(force, stage.targets));
}

TermAccount CoulombForce::account() const {
  return {.energy = "coulomb_energy",
          .energy_meaning = "of all pairs of charges, as they act",
          .channel = {},
          .of_charges_only = true};
}

double CoulombForce::energy(const Stage& stage) {
  return solver_->energy(stage.columns.position(), stage.charge);
}

// Beads at both ends of the chain that have kept place and charge bring no change but with those
// between.
double CoulombForce::energy_change(const Stage& before, const Stage& after) {
  const auto r = before.columns.position(), s = after.columns.position();
  const std::size_t m = before.beads(), n = after.beads(), shorter = std::min(m, n);
  const auto same = [&](std::size_t i, std::size_t j) {
    return r[i] == s[j] && before.charge[i] == after.charge[j];
  };
  std::size_t head = 0, tail = 0;
  while (head < shorter && same(head, head)) ++head;
  while (head + tail < shorter && same(m - 1 - tail, n - 1 - tail)) ++tail;
  constexpr std::size_t few = 32;
  if (m + n - 2 * (head + tail) > few) return energy(after) - energy(before);
  // Of the pairs that have a member in [begin, end).
  const auto energy_of_some = [](ConstVec3View place, std::span<const double> q,
                                 std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum += q[i]
             * (potential_sum(place[i], place, q, 0, i)
                + potential_sum(place[i], place, q, end, q.size()));
    return constants::coulomb * sum;
  };
  return energy_of_some(s, after.charge, head, n - tail)
         - energy_of_some(r, before.charge, head, m - tail);
}

double CoulombForce::feeding_power(const Stage& stage, const LinkContent& rate) {
  const auto r = stage.columns.position();
  return rate.charge * (constants::coulomb * pair_sum(r[1], r, stage.charge, 1).potential);
}

void CoulombForce::add_force_on(std::span<const std::size_t> beads, const Stage& stage,
                                Vec3View force) {
  const auto r = stage.columns.position();
  for (const std::size_t k : beads)
    force.add(k, constants::coulomb * stage.charge[k]
                     * pair_sum(r[k], r, stage.charge, k).field());
}

std::optional<TermReport> CoulombForce::report() const {
  TermReport report{.method = solver_->description(),
                    .coincident_pairs = coincident_pairs_};
  if (const auto checks = solver_->checks())
    report.checks = {.last_error = checks->last, .violations = checks->violations};
  return report;
}

} // namespace ehdjet
