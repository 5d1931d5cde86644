#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/dynamics/array_dynamics.hpp"
#include "ehdjet/events/dense_step.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/integrators/step_size_control.hpp"
#include "ehdjet/observers/array_observer.hpp"
#include "ehdjet/simulation/step_limits.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// Several jets that repel each other, what moves them, what happens to each and who watches: the loop
/// of `Simulation` over one common step (model 9).
///
/// All jets are integrated together. Each has its own events, which look at its part of the step. The
/// first event of any jet ends the step for all of them, is applied to its jet, and the integrator
/// restarts. Every step has one rate.
class ArraySimulation {
public:
  /// A jet in coordinates from its own axis, and what happens to it. All jets have the same kinds of
  /// events in the same order.
  struct Member {
    JetState jet;
    std::vector<std::unique_ptr<Event>> events = {};
  };
  /// The members in the order of the jets of `dynamics`.
  ArraySimulation(std::vector<Member> members, std::unique_ptr<ArrayDynamics> dynamics,
                  std::unique_ptr<Integrator> integrator, const StepLimits& limits);

  void add(std::shared_ptr<ArrayObserver> observer);
  /// Events are applied at the end of the step that contains them.
  void snap_events_to_step_ends() { events_located_ = false; }
  /// Calls `hook` at the end of every step; it may throw to end the run.
  using StepHook = std::function<void(const ArraySimulation&)>;
  void after_each_step(StepHook hook) { hooks_.push_back(std::move(hook)); }
  /// As those of `Simulation`.
  void between_attempts(const std::function<void()>& hook) { between_attempts_ = hook; }
  void make_checkpoints(double interval);
  void make_checkpoints_when(std::function<bool()> wanted);
  void restore(const Checkpoint& checkpoint);

  /// Runs to `end_time` [s]; observers see times up to and including it.
  /// errors : RunError with time, jet and bead when the step size collapses or a state is not a number
  void run_until(double end_time);

  [[nodiscard]] double time() const { return time_; } ///< [s]
  [[nodiscard]] std::size_t jets() const { return jets_.size(); }
  /// Jet j in coordinates from its own axis, or from that of the array.
  [[nodiscard]] const JetState& jet(std::size_t j) const { return jets_[j]; }
  [[nodiscard]] JetState jet_in_array(std::size_t j) const;
  [[nodiscard]] const Ledger& ledger(std::size_t j) const { return ledgers_[j]; }
  [[nodiscard]] std::span<const Ledger> ledgers() const { return ledgers_; }
  [[nodiscard]] const RunStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const ArrayDynamics& dynamics() const { return *dynamics_; }
  [[nodiscard]] std::size_t links() const; ///< of all jets
  [[nodiscard]] std::size_t beads() const { return links() + jets(); }

private:
  struct Found {
    std::size_t jet, event;
    double theta;
  };

  double choose_step();
  double attempt_step(double h);
  void count_cost();
  [[nodiscard]] bool any_link_vanishes();
  void advance(double h, double end_time);
  [[nodiscard]] RowsOfStep part_of_step(std::size_t j, double h) const;
  [[nodiscard]] std::optional<Found> find_event(double h) const;
  [[nodiscard]] double expected_event(double h) const;
  void stop_at(double h, double theta);
  void spread_state(double t);
  void gather_state();
  void show_until(double h, double end);
  void show_now(double end_time);
  void show(ArrayObserver& observer, double t);
  void apply_events(const std::optional<Found>& found);
  bool apply_events(std::size_t j, std::optional<std::size_t> located);
  void tell(std::size_t j);
  [[nodiscard]] bool checkpoint_is_due() const;
  void make_checkpoint();
  void archive(const Archive& a);
  [[noreturn]] void fail(double h, const char* why);
  [[noreturn]] void fail_at_link(double h);

  std::vector<JetState> jets_; // each in coordinates from its own axis
  std::vector<std::vector<std::unique_ptr<Event>>> events_;
  std::vector<Ledger> ledgers_;
  std::unique_ptr<ArrayDynamics> dynamics_;
  std::unique_ptr<Integrator> integrator_;
  StepLimits limits_;
  StepSizeControl control_;
  std::vector<std::shared_ptr<ArrayObserver>> observers_;
  std::vector<StepHook> hooks_;
  std::function<void()> between_attempts_;
  bool events_located_ = true;

  RunStatistics statistics_;
  CompensatedSum time_;
  std::vector<double> y_;    // of all jets: what the integrator advances
  std::vector<double> room_; // a state of one jet or of all
  double step_ = 0;          // what to attempt next; 0: nothing known yet [s]
  double expected_event_ = std::numeric_limits<double>::infinity(); // [s]
  std::vector<double> restart_step_; // per event: a step that suits the motion after it [s]
  std::optional<std::size_t> after_event_; // the kind of event that the next step follows
  std::optional<std::size_t> vanishing_jet_, vanishing_bead_;       // in the last attempt
  double checkpoint_interval_ = 0;                                  // 0: none are made [s]
  double checkpoint_due_ = std::numeric_limits<double>::infinity(); // [s]
  std::function<bool()> checkpoint_wanted_;
  double restored_at_ = 0; // time of the checkpoint that this run goes on from [s]
  Checkpoint restored_;    // what it says about observers, for those that are added later
  std::vector<JetState> seen_; // what observers are shown
  std::vector<Ledger> seen_ledgers_;
  std::vector<DepositedBead> deposited_;
  std::vector<RefinementRecord> refined_;
};

} // namespace ehdjet
