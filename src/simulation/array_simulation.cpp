#include "ehdjet/simulation/array_simulation.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "steps.hpp"

namespace ehdjet {
namespace {

void shift(JetState& jet, const JetAxis& axis) {
  const Vec3View r = jet.columns().position();
  for (double& y : r.y) y += axis.y;
  for (double& z : r.z) z += axis.z;
}

} // namespace

ArraySimulation::ArraySimulation(std::vector<Member> members,
                                 std::unique_ptr<ArrayDynamics> dynamics,
                                 std::unique_ptr<Integrator> integrator,
                                 const StepLimits& limits)
    : dynamics_(std::move(dynamics))
    , integrator_(std::move(integrator))
    , limits_(limits)
    , control_(integrator_->error_order()) {
  EHDJET_EXPECTS(!members.empty() && members.size() == dynamics_->jets());
  EHDJET_EXPECTS(limits_.fixed || integrator_->error_order() > 0);
  for (Member& m : members) {
    ledgers_.push_back(ledger_at_start(m.jet));
    jets_.push_back(std::move(m.jet)), events_.push_back(std::move(m.events));
  }
  restart_step_.resize(events_.front().size());
  time_ = CompensatedSum(jets_.front().time);
  if (integrator_->method_in_use() != integrator_->name())
    statistics_.method =
        MethodRecord{.in_use = integrator_->method_in_use(), .since = time_};
  gather_state();
}

void ArraySimulation::add(std::shared_ptr<ArrayObserver> observer) {
  observer->skip_to(restored_at_);
  if (!restored_.empty()) observer->archive(Archive::from(restored_).part(observers_part));
  observers_.push_back(std::move(observer));
}

JetState ArraySimulation::jet_in_array(std::size_t j) const {
  JetState jet = jets_[j];
  shift(jet, dynamics_->axis(j));
  return jet;
}

std::size_t ArraySimulation::links() const {
  std::size_t links = 0;
  for (const JetState& jet : jets_) links += jet.links();
  return links;
}

/// Takes over the chains of all jets.
void ArraySimulation::gather_state() {
  std::size_t size = 0;
  for (std::size_t j = 0; j < jets(); ++j) {
    dynamics_->bind(j, jets_[j]);
    dynamics_->jet(j).prescribe(time_, jets_[j].y);
    size += jets_[j].y.size();
  }
  y_.resize(size);
  for (std::size_t j = 0; j < jets(); ++j) dynamics_->put(jets_[j].y, j, y_);
}

/// Gives each jet its part of the state at time t.
void ArraySimulation::spread_state(double t) {
  dynamics_->prescribe(t, y_);
  for (std::size_t j = 0; j < jets(); ++j) {
    JetState& jet = jets_[j];
    jet.time = t;
    dynamics_->take(y_, j, jet.y);
    if (dynamics_->jet(j).feeds()) feed(dynamics_->jet(j), jet, ledgers_[j]);
  }
}

void ArraySimulation::run_until(double end_time) {
  const WallClock clock;
  const double wall_before = statistics_.wall_time;
  bool cut = false; // by the end: a run with a later end goes another way from here on
  while (!(time_ >= end_time)) {
    const double to_end = end_time - time_;
    const double wanted = choose_step();
    const bool last = wanted >= nearly * to_end;
    cut |= last;
    advance(attempt_step(last ? to_end : wanted), end_time);
    statistics_.wall_time = wall_before + clock.seconds();
    if (!cut && checkpoint_is_due()) make_checkpoint();
    for (const StepHook& hook : hooks_) hook(*this);
  }
  show_now(end_time);
}

double ArraySimulation::choose_step() {
  if (limits_.fixed) return *limits_.fixed;
  if (step_ == 0) {
    step_ = limits_.initial.value_or(integrator_->initial_step(*dynamics_, time_, y_));
    if (step_ == 0) step_ = never; // nothing moves
  }
  double h = std::min(step_, limits_.longest);
  const double remaining = aim_beyond * (expected_event_ - time_);
  if (remaining > 0 && remaining < 2 * h) h = remaining > h ? remaining / 2 : remaining;
  return h;
}

double ArraySimulation::attempt_step(double h) {
  for (;;) {
    const StepOutcome outcome = integrator_->attempt(*dynamics_, time_, h, y_);
    count_cost();
    control_.set_error_order(integrator_->error_order());
    if (limits_.fixed) {
      if (!std::isfinite(outcome.error)) fail(h, "the state is not a number after");
      if (any_link_vanishes()) fail_at_link(h);
      break;
    }
    const bool exact = outcome.error <= 1; // false for a NaN
    const bool vanishes = exact && any_link_vanishes();
    if (exact && !vanishes) {
      step_ = control_.after_accepted(h, outcome.error);
      break;
    }
    ++statistics_.rejected;
    const double next = exact ? h / 4 : control_.after_rejected(h, outcome.error);
    const double round_off = 4 * std::numeric_limits<double>::epsilon() * time_;
    if (!(next >= limits_.shortest && next >= round_off)) {
      if (vanishes) fail_at_link(h);
      fail(h, "the step size collapsed at");
    }
    h = next;
    if (between_attempts_) between_attempts_();
  }
  count_step(statistics_, h);
  note_method(statistics_, integrator_->method_in_use(), time_);
  if (after_event_) restart_step_[*after_event_] = step_;
  after_event_.reset();
  return h;
}

void ArraySimulation::count_cost() {
  statistics_.evaluations = dynamics_->evaluations();
  statistics_.coincident_pairs = dynamics_->coincident_pairs();
  if (const auto checks = dynamics_->solver().checks()) {
    statistics_.coulomb_error = checks->last;
    statistics_.coulomb_violations = checks->violations;
  }
}

bool ArraySimulation::any_link_vanishes() {
  for (std::size_t j = 0; j < jets(); ++j) {
    room_.resize(jets_[j].y.size());
    dynamics_->take(integrator_->end_state(), j, room_);
    vanishing_jet_ = j;
    vanishing_bead_ = vanishing_link(jets_[j], room_, limits_.shortest_link);
    if (vanishing_bead_) return true;
  }
  return false;
}

RowsOfStep ArraySimulation::part_of_step(std::size_t j, double h) const {
  return {time_,
          h,
          jets_[j],
          *integrator_,
          *dynamics_,
          dynamics_->rows(j).begin,
          dynamics_->beads()};
}

std::optional<ArraySimulation::Found> ArraySimulation::find_event(double h) const {
  std::optional<Found> first;
  for (std::size_t j = 0; j < jets(); ++j) {
    const auto found = first_event(events_[j], part_of_step(j, h));
    if (found && (!first || found->theta < first->theta))
      first = {j, found->index, found->theta};
  }
  return first;
}

double ArraySimulation::expected_event(double h) const {
  double earliest = never;
  for (std::size_t j = 0; j < jets(); ++j)
    earliest = std::min(earliest, expected_time(events_[j], part_of_step(j, h)));
  return earliest;
}

// Goes to the end of the step that has just been attempted, or to the first event in it, which is
// applied.
void ArraySimulation::advance(double h, double end_time) {
  const auto found = events_located_ ? find_event(h) : std::nullopt;
  const double theta = found ? found->theta : 1.0;
  CompensatedSum next_time = time_;
  next_time += theta * h;
  if (!found && h == end_time - time_)
    next_time = CompensatedSum(end_time); // whatever the round-off
  if (const auto t =
          found ? events_[found->jet][found->event]->scheduled_time() : std::nullopt)
    next_time = CompensatedSum(*t);
  show_until(h, next_time);
  expected_event_ = !found && events_located_ ? expected_event(h) : never;

  if (found)
    stop_at(h, theta);
  else
    integrator_->commit(y_);
  time_ = next_time;
  spread_state(time_);
  if (found)
    for (std::size_t j = 0; j < jets(); ++j)
      for (std::size_t i = 0; i < events_[j].size(); ++i)
        if (j != found->jet || i != found->event) events_[j][i]->overtaken(time_);
  apply_events(found);
}

// With fixed steps the state at the event is a step of the method itself, as in Simulation::stop_at.
void ArraySimulation::stop_at(double h, double theta) {
  if (limits_.fixed && theta > 0) {
    integrator_->attempt(*dynamics_, time_, theta * h, y_);
    integrator_->commit(y_);
  } else if (theta == 1) {
    integrator_->commit(y_);
  } else if (theta > 0) {
    room_.resize(y_.size());
    integrator_->prepare_dense_output(*dynamics_);
    integrator_->dense_output(theta, 0, room_);
    y_.swap(room_);
  }
  integrator_->restart();
}

void ArraySimulation::apply_events(const std::optional<Found>& found) {
  bool any = false;
  for (std::size_t j = 0; j < jets(); ++j)
    any |= apply_events(j, found && found->jet == j ? std::optional(found->event)
                                                    : std::nullopt);
  if (!any) return;
  gather_state();
  integrator_->restart();
}

/// Of one jet: the located one, and all that are due.
bool ArraySimulation::apply_events(std::size_t j, std::optional<std::size_t> located) {
  EventContext context{jets_[j], ledgers_[j], statistics_, deposited_, refined_};
  bool any = false;
  for (std::size_t i = 0; i < events_[j].size();) {
    Event& event = *events_[j][i];
    if (i != located && !event.due(jets_[j])) {
      ++i;
      continue;
    }
    event.apply(context);
    any = true;
    if (event.restarts_motion()) {
      after_event_ = i;
      if (restart_step_[i] > 0) step_ = restart_step_[i];
    }
    located.reset();
    i = 0; // one event may bring about another at the same instant; landings come first
  }
  if (any) tell(j);
  return any;
}

/// Tells observers what has happened to jet j.
void ArraySimulation::tell(std::size_t j) {
  const JetAxis& axis = dynamics_->axis(j);
  for (DepositedBead& bead : deposited_) {
    bead.bead.position += Vec3(0, axis.y, axis.z);
    for (const auto& o : observers_) o->deposit(j, bead);
  }
  deposited_.clear();
  for (const RefinementRecord& record : refined_)
    for (const auto& o : observers_) o->refined(j, record);
  refined_.clear();
}

void ArraySimulation::show(ArrayObserver& observer, double t) {
  for (std::size_t j = 0; j < jets(); ++j) shift(seen_[j], dynamics_->axis(j));
  at_time(t, [&] { observer.observe({t, seen_, seen_ledgers_, statistics_}); });
}

void ArraySimulation::show_until(double h, double end) {
  for (const auto& o : observers_)
    while (o->next_time() < end) {
      const double t = o->next_time();
      const double theta = std::clamp((t - time_) / h, 0.0, 1.0);
      seen_ = jets_, seen_ledgers_ = ledgers_;
      for (std::size_t j = 0; j < jets(); ++j) {
        const JetDynamics& dynamics = dynamics_->jet(j);
        part_of_step(j, h).chain_at(theta, t, seen_[j]);
        dynamics.prescribe(t, seen_[j].y);
        seen_[j].time = t;
        if (dynamics.feeds()) feed(dynamics, seen_[j], seen_ledgers_[j]);
        for (const auto& e : events_[j]) e->anticipate(t, seen_[j]);
      }
      show(*o, t);
    }
}

void ArraySimulation::show_now(double end_time) {
  for (const auto& o : observers_)
    while (const auto t = output_time(o->next_time(), end_time)) {
      seen_ = jets_, seen_ledgers_ = ledgers_;
      show(*o, *t);
    }
}

void ArraySimulation::make_checkpoints(double interval) {
  EHDJET_EXPECTS(interval > 0);
  checkpoint_interval_ = interval;
  checkpoint_due_ = next_multiple(checkpoint_interval_, time_);
}

void ArraySimulation::make_checkpoints_when(std::function<bool()> wanted) {
  checkpoint_wanted_ = std::move(wanted);
}

bool ArraySimulation::checkpoint_is_due() const {
  return time_ >= checkpoint_due_ || (checkpoint_wanted_ && checkpoint_wanted_());
}

void ArraySimulation::make_checkpoint() {
  Checkpoint checkpoint;
  archive(Archive::into(checkpoint));
  for (const auto& o : observers_)
    o->archive(Archive::into(checkpoint).part(observers_part));
  if (checkpoint_interval_ > 0)
    checkpoint_due_ = next_multiple(checkpoint_interval_, time_);
  at_time(time_, [&] {
    for (const auto& o : observers_) o->checkpoint(checkpoint);
  });
}

void ArraySimulation::restore(const Checkpoint& checkpoint) {
  const std::size_t events = restart_step_.size();
  const Archive a = Archive::from(checkpoint);
  archive(a);
  a.require("step", step_ >= 0, "is negative");
  a.require("restart_step", restart_step_.size() == events, "is of another scene");
  a.require("restart_step", none_negative(restart_step_), "is negative");
  a.require("after_event", !after_event_ || *after_event_ < events, "is of another scene");
  for (std::size_t j = 0; j < jets(); ++j) {
    const Ledger& ledger = ledgers_[j];
    const JetDynamics& dynamics = dynamics_->jet(j);
    const Constraints& c = dynamics.constraints();
    const auto of = [j](const char* name) { return fmt::format("jet{}.{}", j, name); };
    a.require(of("state.time"), jets_[j].time == time_, "differs from time");
    a.require(of("state.has_embryo"),
              (c.inflow != nullptr && !dynamics.feeds()) || !jets_[j].has_embryo,
              "is of another scene");
    a.require(of("state.fed_since"), dynamics.feeds() || jets_[j].fed_since == 0,
              "is of another scene");
    a.require(of("ledger.inserted_beads"),
              statistics_.refinements
                  || ledger.inserted_beads - ledger.removed_beads == jets_[j].links(),
              "does not agree with the length of the chain");
  }
  if (statistics_.method) statistics_.method->in_use = integrator_->method_in_use();
  restored_at_ = time_;
  restored_ = part_of(checkpoint, observers_part);
  for (const auto& o : observers_) {
    o->skip_to(restored_at_);
    o->archive(Archive::from(restored_).part(observers_part));
  }
  if (checkpoint_interval_ > 0)
    checkpoint_due_ = next_multiple(checkpoint_interval_, time_);
  gather_state();
}

// All that the loop looks at before it writes to it, and nothing of the scene.
void ArraySimulation::archive(const Archive& a) {
  for (std::size_t j = 0; j < jets(); ++j) {
    const Archive own = a.part(fmt::format("jet{}", j));
    ehdjet::archive(own.part("state"), jets_[j]);
    ehdjet::archive(own.part("ledger"), ledgers_[j]);
    for (const auto& e : events_[j]) e->archive(own.part(e->name()));
  }
  ehdjet::archive(a.part("statistics"), statistics_);
  a("time", time_), a("step", step_), a("expected_event", expected_event_);
  a("restart_step", restart_step_), a("after_event", after_event_);
  control_.archive(a.part("step_size_control"));
  integrator_->archive(a.part("integrator"));
  dynamics_->archive(a.part("dynamics"));
}

void ArraySimulation::fail(double h, const char* why) {
  const std::size_t worst = integrator_->worst_component(), n = dynamics_->beads();
  const std::size_t row = worst % n;
  std::size_t j = 0;
  while (row >= dynamics_->rows(j).end) ++j;
  const std::size_t bead = row - dynamics_->rows(j).begin;
  room_.resize(y_.size());
  dynamics_->evaluate(time_, y_, room_); // for the Coulomb forces there
  const double t = time_;
  throw RunError(fmt::format(
      "{} t = {:.9g} s (step {:.3g} s), where {} of bead {} of jet {} changes too fast; "
      "{}. "
      "If the motion is as it should be there, a larger integrator.rtol or a smaller "
      "integrator.min_step may get past it",
      why, t, h, jets_[j].table->integrated()[worst / n].name, bead, j,
      dynamics_->jet(j).diagnosis(t, jets_[j].y, bead)));
}

void ArraySimulation::fail_at_link(double h) {
  const std::size_t j = *vanishing_jet_;
  room_.resize(y_.size());
  dynamics_->evaluate(time_, y_, room_); // for the Coulomb forces there
  throw RunError(fmt::format("jet {}: {}", j,
                             vanishing_text(jets_[j], dynamics_->jet(j), h,
                                            *vanishing_bead_, limits_.shortest_link)));
}

} // namespace ehdjet
