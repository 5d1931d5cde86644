#pragma once

#include "ehdjet/budget/balance.hpp"
#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/events/dense_step.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/observers/observer.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ehdjet {

/// Energy and momentum of a jet over a run: what it has, what has come in and gone out, and what
/// does not add up (model 8).
///
///     residual = E(t) - E(0) - sum over channels of the integrals of their flows and their jumps
///
/// Flows are integrated by Gauss-Legendre quadrature over the dense output of each step, jumps
/// are energies after less before each event. The residual shows every force that does not fit
/// its energy, up to the errors of the steps and of the Coulomb solver.
///
/// The jet is the same with or without it, bit for bit. Does not survive a change of the jet
/// other than by the simulation it is added to.
class Budget final : public Observer, public Accounts {
public:
  /// Of a simulation with these equations of motion and events; both outlive the budget.
  Budget(const JetDynamics& dynamics, std::span<const std::unique_ptr<Event>> events);

  [[nodiscard]] Interest interest() const override { return {.steps_and_events = true}; }
  void begin_step(const DenseStep& step,
                  std::span<const std::unique_ptr<Event>> events) override;
  void end_step(double t, double theta) override;
  void before_event(const Event& event, const JetState& jet) override;
  void after_event(const Event& event, const JetState& jet) override;
  void archive(const Archive& a) override;

  [[nodiscard]] std::span<const Column> columns() const override { return columns_; }
  void measure(const JetSnapshot& snapshot, std::span<double> row) override;

private:
  struct Sum {
    CompensatedSum energy, x, y, z;
    void add(const Flow& flow, double factor);
    [[nodiscard]] Vec3 momentum() const { return {x, y, z}; }
    void archive(const Archive& a) { a("energy", energy), a("x", x), a("y", y), a("z", z); }
  };

  void advance(double t, double theta);
  void integrate(double theta);
  void pass(const DenseStep::InnerTime& inner);
  void look_into_step(double theta, double t, double past);
  template <class Add>
  void list(const JetEnergies& now, const Add& add) const;

  Balance balance_;
  std::vector<Column> columns_;
  std::optional<JetEnergies> start_;
  std::vector<Sum> sums_; // of the channels

  const DenseStep* step_ = nullptr; // in progress
  std::span<const std::unique_ptr<Event>> events_;
  double theta_ = 0;                        // accounted for up to here
  std::vector<DenseStep::InnerTime> inner_; // what does not end the step, ascending
  std::size_t next_inner_ = 0;              // of them
  JetState seen_;                           // inside a step
  JetState before_;                         // an event
};

} // namespace ehdjet
