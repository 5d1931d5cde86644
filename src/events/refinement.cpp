#include "ehdjet/events/refinement.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {
namespace {

constexpr double round_off = 1e-12; // of times

/// A mesh that is refused does not know when.
template <class Cut>
auto at_time(double t, const Cut& cut) {
  try {
    return cut();
  } catch (const RunError& e) {
    throw RunError(fmt::format("at t = {:.9g} s: {}", t, e.what()));
  }
}

JetTotals difference(const JetTotals& after, const JetTotals& before) {
  return {.mass = after.mass - before.mass,
          .charge = after.charge - before.charge,
          .volume = after.volume - before.volume,
          .momentum = after.momentum - before.momentum,
          .kinetic_energy = after.kinetic_energy - before.kinetic_energy,
          .elastic_energy = after.elastic_energy - before.elastic_energy,
          .coulomb_energy = after.coulomb_energy - before.coulomb_energy};
}

/// Joins and cuts links as the rule says, counts it and records it if there are totals.
void change_mesh(EventContext& context, const RefinementRule& rule,
                 const Refinement::Totals& totals,
                 std::optional<MeshChange> (*cut_anew)(JetState&, const RefinementRule&)) {
  JetState& jet = context.jet;
  const JetTotals before = totals ? totals(jet) : JetTotals{};
  const std::size_t beads_before = jet.beads();
  const auto joined = rule.joins() ? coarsen_jet(jet, rule) : std::nullopt;
  const auto cut = at_time(jet.time, [&] { return cut_anew(jet, rule); });
  if (!joined && !cut) return;
  auto& count = context.statistics.refinements;
  count = count.value_or(0) + 1;
  if (!totals) return;
  context.refined.push_back(
      {.time = jet.time,
       .kept = std::min(joined ? joined->kept : jet.links(), cut ? cut->kept : jet.links()),
       .beads_before = beads_before,
       .beads_after = jet.beads(),
       .change = difference(totals(jet), before),
       .worst_link = cut ? cut->worst_link : 0});
}

} // namespace

Refinement::Refinement(const RefinementRule& rule, double interval, Totals totals,
                       bool at_step_ends)
    : rule_(rule)
    , schedule_(interval, 1)
    , totals_(std::move(totals))
    , at_step_ends_(at_step_ends) {}

bool Refinement::due(const JetState& jet) const {
  const double t = schedule_.next(), late = jet.time - t;
  if (at_step_ends_) return late >= -round_off * t;
  return std::abs(late) <= round_off * t && changes(jet);
}

std::optional<double> Refinement::locate(const DenseStep& step) {
  pass(step.t0); // multiples at which there was nothing to do
  if (!step.keeps_chain()) return std::nullopt;
  const double end = step.time(1);
  for (Schedule next = schedule_; next.next() <= end; next.advance()) {
    const double theta = std::min((next.next() - step.t0) / step.h, 1.0);
    probe_ = step.jet;
    step.state(theta, probe_.y);
    if (!at_time(next.next(), [&] { return changes(probe_); })) continue;
    located_ = next.next();
    return theta;
  }
  return std::nullopt;
}

double Refinement::next_time(double t) const {
  return schedule_.next_after(t);
}

void Refinement::pass(double t) {
  while (schedule_.next() <= t * (1 + round_off)) schedule_.advance();
}

bool Refinement::changes(const JetState& jet) const {
  if (has_short_links(jet, rule_)) return true;
  return plan_mesh(JetString(jet), rule_.first_knot(), rule_.length).has_value();
}

void Refinement::apply(EventContext& context) {
  pass(context.jet.time);
  change_mesh(context, rule_, totals_, refine_jet);
}

LinkCuts::LinkCuts(const RefinementRule& rule, std::optional<double> interval,
                   Refinement::Totals totals, bool at_step_ends)
    : rule_(rule)
    , totals_(std::move(totals))
    , at_step_ends_(at_step_ends) {
  if (interval) schedule_.emplace(*interval, 1);
}

bool LinkCuts::due(const JetState& jet) const {
  if (schedule_ && jet.time < schedule_->next() * (1 - round_off)) return false;
  if (schedule_ && at_step_ends_) return true; // `apply` passes the multiple
  if (has_long_link(jet, rule_)) return true;
  return !(jet.time == instant_ && joins_ >= most_joins) && has_short_links(jet, rule_);
}

std::optional<double> LinkCuts::locate(const DenseStep& step) {
  pass(step.t0); // multiples at which there was nothing to do
  return std::nullopt;
}

double LinkCuts::next_time(double t) const {
  return schedule_ ? schedule_->next_after(t) : Event::next_time(t);
}

void LinkCuts::pass(double t) {
  if (schedule_)
    while (schedule_->next() <= t * (1 + round_off)) schedule_->advance();
}

void LinkCuts::apply(EventContext& context) {
  pass(context.jet.time);
  if (rule_.shortest) {
    if (context.jet.time != instant_) instant_ = context.jet.time, joins_ = 0;
    ++joins_;
  }
  change_mesh(context, rule_, totals_, cut_links);
}

} // namespace ehdjet
