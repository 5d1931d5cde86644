#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ehdjet {
namespace {

/// Smallest |d0 + s (d1 - d0)|^2 for s from 0 to 1.
double closest_approach(const Vec3& d0, const Vec3& d1) {
  const Vec3 e = d1 - d0;
  const double square = e.squaredNorm();
  const double s = square > 0 ? std::clamp(-d0.dot(e) / square, 0.0, 1.0) : 0.0;
  return (d0 + s * e).squaredNorm();
}

} // namespace

double next_multiple(double interval, double t) {
  double count = std::floor(t / interval);
  while (count * interval <= t) ++count;
  return count * interval;
}

std::optional<double> output_time(double time, double end) {
  constexpr double round_off = 1e-12;
  if (time > end * (1 + round_off)) return std::nullopt;
  return std::min(time, end);
}

Checkpoint part_of(const Checkpoint& checkpoint, std::string_view name) {
  const std::string prefix = std::string(name) + '.';
  Checkpoint part;
  for (auto i = checkpoint.lower_bound(prefix);
       i != checkpoint.end() && i->first.starts_with(prefix); ++i)
    part.insert(*i);
  return part;
}

Ledger ledger_at_start(const JetState& jet) {
  Ledger ledger;
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    ++ledger.inserted_beads;
    ledger.inserted_mass += jet.mass[k];
    ledger.inserted_charge += jet.charge[k];
    ledger.inserted_volume += jet.volume[k];
  }
  return ledger;
}

void count_step(RunStatistics& statistics, double h) {
  ++statistics.steps;
  statistics.shortest_step = std::min(statistics.shortest_step, h);
  statistics.longest_step = std::max(statistics.longest_step, h);
}

void note_method(RunStatistics& statistics, std::string_view in_use, double t) {
  if (!statistics.method || in_use == statistics.method->in_use) return;
  MethodRecord& record = *statistics.method;
  // What the first step was taken with is the start, not a change.
  if (statistics.steps > 1) ++record.changes;
  record.in_use = in_use, record.since = t;
}

std::optional<FoundEvent> first_event(Events events, const DenseStep& step) {
  std::optional<FoundEvent> first;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto theta = events[i]->locate(step);
    if (theta && (!first || *theta < first->theta)) first = {i, *theta};
  }
  return first;
}

double expected_time(Events events, const DenseStep& step) {
  double earliest = never;
  for (const auto& e : events)
    if (const auto theta = e->predict(step))
      earliest = std::min(earliest, step.time(*theta));
  return earliest;
}

void feed(const JetDynamics& dynamics, JetState& jet, Ledger& ledger) {
  const LinkContent full{
      .volume = jet.volume[1], .mass = jet.mass[1], .charge = jet.charge[1]};
  const LinkContent now = dynamics.constraints().inflow->acting(
      full, jet.fed_since, jet.time, std::as_const(jet).columns().position());
  jet.volume[1] = now.volume, jet.mass[1] = now.mass, jet.charge[1] = now.charge;
  ledger.inserted_volume += now.volume - full.volume;
  ledger.inserted_mass += now.mass - full.mass;
  ledger.inserted_charge += now.charge - full.charge;
}

std::optional<std::size_t> vanishing_link(const JetState& jet, std::span<const double> end,
                                          double shortest) {
  const double limit = shortest * shortest;
  if (limit == 0) return std::nullopt;
  const std::size_t n = jet.beads();
  const auto before = jet.columns().position();
  const auto after = JetColumns<const double>{end, n}.position();
  for (std::size_t k = jet.first(), up = 0; k < n; up = k++) {
    if (closest_approach(before[k] - before[up], after[k] - after[up]) >= limit) continue;
    if (jet.is_landed(k) && jet.is_landed(up)) continue;
    if (jet.absorbing_plane && after.x[up] > *jet.absorbing_plane) continue;
    return k;
  }
  return std::nullopt;
}

std::string vanishing_text(const JetState& jet, JetDynamics& dynamics, double h,
                           std::size_t bead, double shortest) {
  const std::size_t up = bead == jet.first() ? 0 : bead - 1;
  return fmt::format(
      "at t = {:.9g} s (step {:.3g} s) bead {} runs into bead {}: their link, "
      "{:.3g} m long, shrinks "
      "below {:.3g} m; {}. A chain cannot pass through itself: look for what "
      "pushes the beads "
      "together, raise viscoelasticity.elastic_modulus or viscosity, or let "
      "refinement.coarsen join short links in time",
      jet.time, h, bead, up, link_length(jet, bead), shortest,
      dynamics.diagnosis(jet.time, jet.y, bead));
}

} // namespace ehdjet
