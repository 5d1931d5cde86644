#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/integrators/step_size_control.hpp"
#include "ehdjet/observers/observer.hpp"
#include "ehdjet/simulation/step_limits.hpp"
#include "ehdjet/simulation/two_rate.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// A jet, what moves it, what happens to it and who watches.
///
/// One pass of the loop: choose h, attempt, and once the error is small enough find the first
/// event inside the step, show the part before it to the observers, advance to it, apply it.
/// Nothing but events changes the chain; nothing but the loop changes the time.
class Simulation {
public:
  Simulation(JetState jet, std::unique_ptr<JetDynamics> dynamics,
             std::unique_ptr<Integrator> integrator, StepLimits limits);

  /// Events at the same instant are applied in the order in which they were added.
  void add(std::unique_ptr<Event> event);
  /// Any number of observers; each is called in the order in which they were added.
  void add(std::shared_ptr<Observer> observer);
  /// Takes macro steps with two rates while the chain is long enough for them.
  void use_two_rates(std::unique_ptr<TwoRate> two_rate);
  /// Apply events at the end of the step that contains them, as the paper did: first order in
  /// the step size, whatever the method.
  void snap_events_to_step_ends() { events_located_ = false; }

  /// Adds an observer that calls `hook` at the end of every step; it may throw to end the run.
  using StepHook = std::function<void(const Simulation&)>;
  void after_each_step(StepHook hook);
  /// Calls `hook` before a step is attempted again, micro steps included; it may throw to end the run, but no
  /// RunError, which would be taken for a failure of that step.
  void between_attempts(const std::function<void()>& hook);

  /// Shows observers a checkpoint at the end of the first step at or after each multiple of
  /// `interval` [s]. No step is cut for it, and none is made that a run with a later end would not
  /// make. Checkpoints do not change the run, and a run that goes on from one has the same bits.
  void make_checkpoints(double interval);
  /// Makes one also at the end of a step at which `wanted` says so. It is asked once per step.
  void make_checkpoints_when(std::function<bool()> wanted);
  /// Goes on from a checkpoint of the same scene. To be called after all events have been added
  /// and before the run.
  /// errors : InputError if it is not from such a scene
  void restore(const Checkpoint& checkpoint);

  /// Goes on with another chain of the same columns, from its time on. What is known about suitable steps
  /// and expected events is kept.
  void take_over(JetState jet, const Ledger& ledger);
  /// What is known about suitable steps and expected events.
  void archive_pace(const Archive& a);

  /// Runs to `end_time` [s]; observers see times up to and including it.
  /// errors : RunError with time, bead and term when the step size collapses or a state is not
  ///          a number; what observers were shown until then stands
  void run_until(double end_time);
  /// One step of `run_until(end_time)`, which makes the same steps. False, without a step, if the jet is
  /// there already.
  bool step(double end_time);

  /// Hands out the jet and goes on with a copy: what referred to its columns stays valid, and shows the
  /// jet as it is now.
  [[nodiscard]] JetState hand_out_jet();

  [[nodiscard]] const JetState& jet() const { return jet_; }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  [[nodiscard]] const RunStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const JetDynamics& dynamics() const { return *dynamics_; }
  [[nodiscard]] std::span<const std::unique_ptr<Event>> events() const { return events_; }

private:
  struct Stretch;
  void take_step(Stretch& stretch);
  void show_rest(double end_time);
  void choose_rates();
  double choose_step(double end_time);
  [[nodiscard]] double even_macro_step(double h) const;
  [[nodiscard]] const Integrator& stepping() const;
  StepOutcome try_step(double h);
  void count_cost();
  double attempt_step(double h);
  void advance(double h, double end_time);
  void advance(const DenseStep& step, double end_time);
  void commit();
  [[nodiscard]] std::optional<std::size_t> vanishing_link() const;
  [[noreturn]] void fail_at_link(double h, std::size_t bead);
  void show_until(const DenseStep& step, double end);
  void stop_at(const DenseStep& step, double theta);
  void apply_events(std::size_t located);
  void apply(Event& event, EventContext& context);
  void archive(const Archive& a);
  [[nodiscard]] bool checkpoint_is_due() const;
  void make_checkpoint();
  [[nodiscard]] JetSnapshot now() const;
  [[noreturn]] void fail(double h, const char* why);

  JetState jet_;
  std::unique_ptr<JetDynamics> dynamics_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<TwoRate> two_rate_; // null: every step has one rate
  bool two_rates_ = false;            // the step at hand has two
  StepLimits limits_;
  StepSizeControl control_;
  bool checks_coulomb_;
  std::vector<std::unique_ptr<Event>> events_;
  std::vector<std::shared_ptr<Observer>> observers_;
  std::vector<Observer*> step_observers_, step_end_observers_; // those of them that want it
  std::function<void()> between_attempts_;
  bool events_located_ = true;

  Ledger ledger_;
  RunStatistics statistics_;
  CompensatedSum time_;
  double step_ = 0;  // what to attempt next; 0: nothing known yet [s]
  double uncut_ = 0; // at least that, if the step is accepted [s]
  double expected_event_ = std::numeric_limits<double>::infinity(); // [s]
  std::vector<double> restart_step_; // per event: a step that suits the motion after it [s]
  std::optional<std::size_t> after_event_; // the event that the next step follows
  double checkpoint_interval_ = 0;         // 0: none are made [s]
  double checkpoint_due_ = std::numeric_limits<double>::infinity(); // [s]
  std::function<bool()> checkpoint_wanted_;
  double restored_at_ = 0; // time of the checkpoint that this run goes on from [s]
  Checkpoint restored_;    // what it says about observers, for those that are added later
  std::vector<double> snapshot_; // a state inside a step
  std::vector<DepositedBead> deposited_;
  std::vector<RefinementRecord> refined_;
};

} // namespace ehdjet
