#include "ehdjet/simulation/simulation.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "steps.hpp"

namespace ehdjet {
namespace {

constexpr std::string_view two_rates = "two-rate"; // as a method

/// Asks the dynamics for the cause when for the first time a rate is not a number.
class FirstNan final : public OdeSystem {
public:
  explicit FirstNan(JetDynamics& dynamics, std::size_t beads)
      : dynamics_(dynamics)
      , beads_(beads) {}
  void prescribe(double t, std::span<double> y) const override {
    dynamics_.prescribe(t, y);
  }
  void evaluate(double t, std::span<const double> y, std::span<double> rate) override {
    dynamics_.evaluate(t, y, rate);
    if (!cause.empty()) return;
    for (std::size_t i = 0; i < rate.size(); ++i)
      if (!std::isfinite(rate[i]) || !std::isfinite(y[i])) {
        cause = dynamics_.diagnosis(t, y, i % beads_);
        return;
      }
  }
  [[nodiscard]] StiffPart* stiff_part() override { return dynamics_.stiff_part(); }
  std::string cause;

private:
  JetDynamics& dynamics_;
  std::size_t beads_;
};

void show(Observer& observer, const JetSnapshot& snapshot) {
  at_time(snapshot.time, [&] { observer.observe(snapshot); });
}

/// Beads at the end of a chain have left it. Within a macro step they are so many that a ledger that waits
/// for its end would be late.
void count_removed(const JetState& jet, std::size_t left, Ledger& ledger) {
  for (std::size_t k = jet.beads(); k-- > left;) {
    ++ledger.removed_beads;
    ledger.removed_mass += jet.mass[k];
    ledger.removed_charge += jet.charge[k];
    ledger.removed_volume += jet.volume[k];
  }
}

/// An observer made of a function.
class AfterEachStep final : public Observer {
public:
  AfterEachStep(const Simulation& simulation, Simulation::StepHook hook)
      : simulation_(simulation)
      , hook_(std::move(hook)) {}
  [[nodiscard]] Interest interest() const override { return {.ends_of_steps = true}; }
  void after_step(const JetSnapshot& /*snapshot*/) override { hook_(simulation_); }

private:
  const Simulation& simulation_; // owns this observer
  Simulation::StepHook hook_;
};

} // namespace

Simulation::Simulation(JetState jet, std::unique_ptr<JetDynamics> dynamics,
                       std::unique_ptr<Integrator> integrator, StepLimits limits)
    : jet_(std::move(jet))
    , dynamics_(std::move(dynamics))
    , integrator_(std::move(integrator))
    , limits_(limits)
    , control_(integrator_->error_order())
    , checks_coulomb_(dynamics_->checks().has_value())
    , time_(jet_.time) {
  EHDJET_EXPECTS(limits_.fixed || integrator_->error_order() > 0);
  ledger_ = ledger_at_start(jet_);
  if (integrator_->method_in_use() != integrator_->name())
    statistics_.method =
        MethodRecord{.in_use = integrator_->method_in_use(), .since = jet_.time};
  dynamics_->bind(jet_);
  dynamics_->prescribe(jet_.time, jet_.y);
}

void Simulation::use_two_rates(std::unique_ptr<TwoRate> two_rate) {
  EHDJET_EXPECTS(!limits_.fixed && events_located_);
  two_rate_ = std::move(two_rate);
  statistics_.two_rates.emplace();
  if (!statistics_.method)
    statistics_.method = MethodRecord{.in_use = integrator_->name(), .since = jet_.time};
}

void Simulation::take_over(JetState jet, const Ledger& ledger) {
  jet_ = std::move(jet), ledger_ = ledger;
  time_ = CompensatedSum(jet_.time);
  dynamics_->bind(jet_);
  dynamics_->prescribe(jet_.time, jet_.y);
  integrator_->restart();
}

void Simulation::add(std::unique_ptr<Event> event) {
  events_.push_back(std::move(event));
  restart_step_.push_back(0);
}

void Simulation::add(std::shared_ptr<Observer> observer) {
  observer->skip_to(restored_at_);
  if (!restored_.empty()) observer->archive(Archive::from(restored_).part(observers_part));
  const Interest interest = observer->interest();
  if (interest.steps_and_events) step_observers_.push_back(observer.get());
  if (interest.ends_of_steps) step_end_observers_.push_back(observer.get());
  observers_.push_back(std::move(observer));
}

void Simulation::between_attempts(const std::function<void()>& hook) {
  between_attempts_ = hook;
  if (two_rate_) two_rate_->between_attempts(hook);
}

void Simulation::after_each_step(StepHook hook) {
  add(std::make_unique<AfterEachStep>(*this, std::move(hook)));
}

JetSnapshot Simulation::now() const {
  return {jet_.time, jet_.columns(), jet_, ledger_, statistics_};
}

// Goes to the end of the step that has just been attempted, or to the first event in it, which is
// applied.
void Simulation::advance(double h, double end_time) {
  if (two_rates_)
    advance(*two_rate_->step(jet_), end_time);
  else
    advance(IntegratorStep(jet_.time, h, jet_, *integrator_, *dynamics_), end_time);
}

void Simulation::advance(const DenseStep& step, double end_time) {
  const double h = step.h;
  const auto found = events_located_ ? first_event(events_, step) : std::nullopt;
  const double theta = found ? found->theta : 1.0;
  CompensatedSum next_time = time_;
  next_time += theta * h;
  if (!found && h == end_time - jet_.time)
    next_time = CompensatedSum(end_time); // whatever the round-off
  if (const auto t = found ? events_[found->index]->scheduled_time() : std::nullopt)
    next_time = CompensatedSum(*t);
  const double t1 = next_time;
  for (Observer* o : step_observers_) o->begin_step(step, events_);
  show_until(step, t1);
  for (Observer* o : step_observers_) o->end_step(t1, theta);
  const bool foresees = !found && events_located_ && step.keeps_chain();
  expected_event_ = foresees ? expected_time(events_, step) : never;

  if (found) {
    stop_at(step, theta);
  } else {
    commit();
  }
  time_ = next_time;
  jet_.time = t1;
  dynamics_->prescribe(jet_.time, jet_.y);
  if (dynamics_->feeds()) feed(*dynamics_, jet_, ledger_);
  if (found)
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (i != found->index) events_[i]->overtaken(t1);
  apply_events(found ? found->index : events_.size());
}

/// Steps up to one end.
struct Simulation::Stretch {
  double end_time, wall_before;
  bool cut = false; // by the end: a run with a later end goes another way from here on
  WallClock clock = {};
};

void Simulation::run_until(double end_time) {
  Stretch stretch{.end_time = end_time, .wall_before = statistics_.wall_time};
  while (!(jet_.time >= end_time)) take_step(stretch);
  show_rest(end_time);
}

bool Simulation::step(double end_time) {
  if (jet_.time >= end_time) return false;
  Stretch stretch{.end_time = end_time, .wall_before = statistics_.wall_time};
  take_step(stretch);
  if (jet_.time >= end_time) show_rest(end_time);
  return true;
}

void Simulation::take_step(Stretch& stretch) {
  const double end_time = stretch.end_time, to_end = end_time - jet_.time;
  const double wanted = choose_step(end_time);
  const bool last = wanted >= nearly * to_end;
  stretch.cut |= last;
  // How short the last step of a short run is says nothing about the next run.
  uncut_ = last && limits_.even_at_end ? wanted : 0;
  advance(attempt_step(last ? to_end : wanted), end_time);
  statistics_.wall_time = stretch.wall_before + stretch.clock.seconds();
  if (!stretch.cut && checkpoint_is_due()) make_checkpoint();
  for (Observer* o : step_end_observers_) o->after_step(now());
}

void Simulation::show_rest(double end_time) {
  for (const auto& o : observers_)
    while (const auto t = output_time(o->next_time(), end_time))
      show(*o, {*t, now().columns, jet_, ledger_, statistics_});
}

JetState Simulation::hand_out_jet() {
  return std::exchange(jet_, JetState(jet_));
}

void Simulation::make_checkpoints(double interval) {
  EHDJET_EXPECTS(interval > 0);
  checkpoint_interval_ = interval;
  checkpoint_due_ = next_multiple(checkpoint_interval_, jet_.time);
}

void Simulation::make_checkpoints_when(std::function<bool()> wanted) {
  checkpoint_wanted_ = std::move(wanted);
}

bool Simulation::checkpoint_is_due() const {
  return jet_.time >= checkpoint_due_ || (checkpoint_wanted_ && checkpoint_wanted_());
}

void Simulation::make_checkpoint() {
  Checkpoint checkpoint;
  archive(Archive::into(checkpoint));
  for (const auto& o : observers_)
    o->archive(Archive::into(checkpoint).part(observers_part));
  if (checkpoint_interval_ > 0)
    checkpoint_due_ = next_multiple(checkpoint_interval_, jet_.time);
  at_time(jet_.time, [&] {
    for (const auto& o : observers_) o->checkpoint(checkpoint);
  });
}

void Simulation::restore(const Checkpoint& checkpoint) {
  const Archive a = Archive::from(checkpoint);
  archive(a);
  const Constraints& c = dynamics_->constraints();
  const bool may_have_embryo = c.inflow != nullptr && !dynamics_->feeds();
  a.require("time", time_ == jet_.time, "differs from jet.time");
  a.require("jet.has_embryo", may_have_embryo || !jet_.has_embryo, "is of another scene");
  a.require("jet.fed_since", dynamics_->feeds() || jet_.fed_since == 0,
            "is of another scene");
  a.require("jet.mat", c.insulating_collector || !jet_.mat, "is of another scene");
  a.require("ledger.inserted_beads",
            statistics_.refinements
                || ledger_.inserted_beads - ledger_.removed_beads == jet_.links(),
            "does not agree with the length of the chain");
  if (statistics_.method)
    statistics_.method->in_use = two_rates_ ? two_rates : integrator_->method_in_use();
  restored_at_ = jet_.time;
  restored_ = part_of(checkpoint, observers_part);
  for (const auto& o : observers_) {
    o->skip_to(restored_at_);
    o->archive(Archive::from(restored_).part(observers_part));
  }
  if (checkpoint_interval_ > 0)
    checkpoint_due_ = next_multiple(checkpoint_interval_, jet_.time);
  dynamics_->bind(jet_);
}

// All that the loop looks at before it writes to it, and nothing of the scene.
void Simulation::archive(const Archive& a) {
  ehdjet::archive(a.part("jet"), jet_);
  ehdjet::archive(a.part("ledger"), ledger_);
  ehdjet::archive(a.part("statistics"), statistics_);
  a("time", time_);
  archive_pace(a);
  dynamics_->archive(a.part("dynamics"));
  for (const auto& e : events_) e->archive(a.part(e->name()));
  if (!two_rate_) return;
  a("two_rates", two_rates_);
  two_rate_->archive(a.part("two_rate"), jet_);
}

void Simulation::archive_pace(const Archive& a) {
  a("step", step_), a("expected_event", expected_event_);
  a("restart_step", restart_step_), a("after_event", after_event_);
  control_.archive(a.part("step_size_control"));
  integrator_->archive(a.part("integrator"));
  const std::size_t events = events_.size();
  a.require("step", step_ >= 0, "is negative");
  a.require("restart_step", restart_step_.size() == events, "is of another scene");
  a.require("restart_step", none_negative(restart_step_), "is negative");
  a.require("after_event", !after_event_ || *after_event_ < events, "is of another scene");
}

// The first step of the other kind is about as long as a step that is known to suit.
void Simulation::choose_rates() {
  if (!two_rate_ || two_rates_ == two_rate_->suits(jet_, two_rates_)) return;
  two_rates_ = !two_rates_;
  std::ranges::fill(restart_step_, 0.0);
  after_event_.reset();
  expected_event_ = never;
  integrator_->restart();
  two_rate_->forget();
  if (!two_rates_) step_ = 0;
}

double Simulation::choose_step(double end_time) {
  if (limits_.fixed) return *limits_.fixed;
  choose_rates();
  if (two_rates_) jet_.absorbing_plane = two_rate_->collector();
  if (step_ == 0) {
    step_ =
        limits_.initial.value_or(integrator_->initial_step(*dynamics_, jet_.time, jet_.y));
    if (step_ == 0) step_ = never; // nothing moves
  }
  // Steps are aimed at expected events: a step that ends far behind one is mostly thrown away,
  // and one that ends just before it leaves a remainder that costs as much as a step.
  double h = std::min(step_, limits_.longest);
  const double remaining = aim_beyond * (expected_event_ - jet_.time);
  if (remaining > 0 && remaining < 2 * h) h = remaining > h ? remaining / 2 : remaining;
  const double to_end = end_time - jet_.time;
  if (limits_.even_at_end && to_end > h && to_end < 2 * h) h = to_end / 2;
  return two_rates_ ? even_macro_step(h) : h;
}

// A whole number of macro steps leads to the next time that must end one. They may be a little longer than
// wanted, which the safety factor of the step size control allows for.
double Simulation::even_macro_step(double h) const {
  constexpr double stretch = 1.08;
  const double longest = std::min(limits_.longest, two_rate_->longest_step());
  double next = never;
  for (const auto& e : events_) next = std::min(next, e->next_time(jet_.time));
  const double remaining = next - jet_.time;
  if (!std::isfinite(remaining)) return std::min(h, longest);
  return remaining / std::ceil(remaining / std::min(stretch * h, longest) * (1 - 1e-9));
}

const Integrator& Simulation::stepping() const {
  return two_rates_ ? two_rate_->integrator() : *integrator_;
}

StepOutcome Simulation::try_step(double h) {
  return two_rates_ ? two_rate_->attempt(jet_, ledger_, h)
                    : integrator_->attempt(*dynamics_, jet_.time, h, jet_.y);
}

void Simulation::count_cost() {
  statistics_.evaluations = dynamics_->evaluations();
  if (two_rate_) two_rate_->count(statistics_);
}

void Simulation::commit() {
  if (!two_rates_) {
    integrator_->commit(jet_.y);
    return;
  }
  two_rate_->commit(jet_, ledger_, statistics_);
  dynamics_->bind(jet_);
}

double Simulation::attempt_step(double h) {
  for (;;) {
    const StepOutcome outcome = try_step(h);
    count_cost();
    if (checks_coulomb_) {
      const TermReport::Checks checks = *dynamics_->checks();
      statistics_.coulomb_error = checks.last_error;
      statistics_.coulomb_violations = checks.violations;
    }
    control_.set_error_order(stepping().error_order());
    if (limits_.fixed) {
      if (!std::isfinite(outcome.error)) fail(h, "the state is not a number after");
      if (const auto bead = vanishing_link()) fail_at_link(h, *bead);
      break;
    }
    // A step without an error of its own may still jump over a singularity.
    const bool exact = outcome.error <= 1; // false for a NaN
    const auto vanishing = exact ? vanishing_link() : std::nullopt;
    if (exact && !vanishing) {
      step_ = std::max(control_.after_accepted(h, outcome.error), uncut_);
      break;
    }
    ++statistics_.rejected;
    uncut_ = 0;
    const double next = exact ? h / 4 : control_.after_rejected(h, outcome.error);
    // A step that no longer changes t is as good as none, and NaN is no step.
    const double round_off = 4 * std::numeric_limits<double>::epsilon() * jet_.time;
    if (!(next >= limits_.shortest && next >= round_off)) {
      if (vanishing) fail_at_link(h, *vanishing);
      fail(h, "the step size collapsed at");
    }
    h = next;
    if (between_attempts_) between_attempts_();
  }
  count_step(statistics_, h);
  note_method(statistics_, two_rates_ ? two_rates : integrator_->method_in_use(),
              jet_.time);
  if (after_event_) restart_step_[*after_event_] = step_;
  after_event_.reset();
  return h;
}

std::optional<std::size_t> Simulation::vanishing_link() const {
  return ehdjet::vanishing_link(jet_, stepping().end_state(), limits_.shortest_link);
}

void Simulation::fail_at_link(double h, std::size_t bead) {
  throw RunError(vanishing_text(jet_, *dynamics_, h, bead, limits_.shortest_link));
}

void Simulation::show_until(const DenseStep& step, double end) {
  for (const auto& o : observers_) {
    while (o->next_time() < end) {
      const double t = o->next_time();
      const double theta = std::clamp((t - step.t0) / step.h, 0.0, 1.0);
      // Beads may have landed or been born without an end of the step, and link 1 may have grown.
      if (jet_.absorbing_plane || dynamics_->feeds() || !step.keeps_chain()) {
        JetState seen = jet_;
        Ledger ledger = ledger_;
        step.chain_at(theta, t, seen);
        step.ledger_at(t, ledger);
        if (step.keeps_chain()) dynamics_->prescribe(t, seen.y);
        seen.time = t;
        if (dynamics_->feeds()) feed(*dynamics_, seen, ledger);
        const auto chain = step.keeps_chain() ? std::nullopt : std::optional(seen);
        for (const auto& e : events_) e->anticipate(t, seen);
        if (chain) count_removed(*chain, seen.beads(), ledger);
        show(*o, {t, std::as_const(seen).columns(), seen, ledger, statistics_});
      } else {
        snapshot_.resize(jet_.y.size());
        step.state(theta, snapshot_);
        dynamics_->prescribe(t, snapshot_);
        show(*o, {t, {snapshot_, jet_.beads()}, jet_, ledger_, statistics_});
      }
    }
  }
}

// Within an error tolerance the dense output serves. Fixed steps are for convergence studies: there
// the state at the event is a step of the method itself, so that interpolation does not blur
// the order.
void Simulation::stop_at(const DenseStep& step, double theta) {
  if (two_rates_) {
    if (step.time(theta) > step.t0) {
      (void)two_rate_->attempt(jet_, ledger_, theta * step.h);
      count_cost();
      commit();
    }
    return;
  }
  if (limits_.fixed && theta > 0) {
    integrator_->attempt(*dynamics_, step.t0, theta * step.h, jet_.y);
    integrator_->commit(jet_.y);
  } else {
    snapshot_.resize(jet_.y.size());
    step.state(theta, snapshot_);
    jet_.y.swap(snapshot_);
  }
  integrator_->restart();
}

void Simulation::apply_events(std::size_t located) {
  EventContext context{jet_, ledger_, statistics_, deposited_, refined_};
  bool any = false, only_end = true;
  for (std::size_t i = 0; i < events_.size();) {
    if (i != located && !events_[i]->due(jet_)) {
      ++i;
      continue;
    }
    apply(*events_[i], context);
    any = true, only_end &= events_[i]->leaves_motion();
    if (events_[i]->restarts_motion()) {
      after_event_ = i;
      if (restart_step_[i] > 0) step_ = restart_step_[i];
    }
    located = events_.size();
    i = 0; // one event may bring about another at the same instant; landings come first
  }
  if (!any) return;
  for (const DepositedBead& bead : deposited_)
    for (const auto& o : observers_) o->deposit(bead);
  deposited_.clear();
  for (const RefinementRecord& record : refined_)
    for (const auto& o : observers_) o->refined(record);
  refined_.clear();
  dynamics_->bind(jet_);
  dynamics_->prescribe(jet_.time, jet_.y);
  integrator_->restart();
  if (two_rates_) two_rate_->chain_changed(jet_, only_end);
}

void Simulation::apply(Event& event, EventContext& context) {
  if (!step_observers_.empty()) {
    JetState seen = jet_; // as if what the step went through had ended it
    for (const auto& e : events_) e->anticipate(jet_.time, seen);
    for (Observer* o : step_observers_) o->before_event(event, seen);
  }
  event.apply(context);
  for (Observer* o : step_observers_) o->after_event(event, jet_);
}

void Simulation::fail(double h, const char* why) {
  const std::size_t worst = stepping().worst_component();
  FirstNan search(*dynamics_, jet_.beads());
  integrator_->restart();
  (void)integrator_->attempt(search, jet_.time, h, jet_.y);
  if (!search.cause.empty())
    throw RunError(fmt::format("{} t = {:.9g} s (step {:.3g} s); {}", why, jet_.time, h,
                               search.cause));
  const std::string cause = dynamics_->diagnosis(jet_.time, jet_.y, worst % jet_.beads());
  throw RunError(fmt::format(
      "{} t = {:.9g} s (step {:.3g} s), where {} of bead {} changes too "
      "fast; {}. If the motion is as it should be there, a larger integrator.rtol or a "
      "smaller "
      "integrator.min_step may get past it",
      why, jet_.time, h, jet_.table->integrated()[worst / jet_.beads()].name,
      worst % jet_.beads(), cause));
}

} // namespace ehdjet
