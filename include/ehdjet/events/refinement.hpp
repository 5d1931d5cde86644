#pragma once

#include "ehdjet/core/schedule.hpp"
#include "ehdjet/events/event.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <functional>
#include <optional>

namespace ehdjet {

/// Cuts the jet anew, at exact multiples of t_ref from the first one on, where its links have
/// become too long, and joins links that are needlessly short if the rule says so (model 7).
class Refinement final : public Event {
public:
  /// Sums over the beads of a jet, for the record of what a refinement changes.
  using Totals = std::function<JetTotals(const JetState&)>;

  /// `interval`: t_ref [s]. Without `totals` nothing is recorded.
  /// `at_step_ends`: happens at the end of the step that contains the multiple of t_ref.
  Refinement(const RefinementRule& rule, double interval, Totals totals = {},
             bool at_step_ends = false);
  [[nodiscard]] std::string_view name() const override { return "refinement"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  /// A multiple of t_ref ends a step only if there is something to do.
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] double next_time(double t) const override;
  [[nodiscard]] std::optional<double> scheduled_time() const override { return located_; }
  [[nodiscard]] std::optional<double> predict(const DenseStep&) const override {
    return {};
  }
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }
  void archive(const Archive& a) override { schedule_.archive(a.part("schedule")); }

private:
  void pass(double t);
  [[nodiscard]] bool changes(const JetState& jet) const;

  RefinementRule rule_;
  Schedule schedule_;
  double located_ = 0; // the multiple that ends the step [s]
  JetState probe_;     // the jet inside a step
  Totals totals_;
  bool at_step_ends_;
};

/// Cuts each link that has become longer than L~, at the end of the step in which it has, and joins
/// links that are needlessly short if the rule says so (model 7). The integrator goes on with its
/// step size.
class LinkCuts final : public Event {
public:
  /// `interval`: only at the first step end at or behind each multiple of it [s]. Without `totals`
  /// nothing is recorded. `at_step_ends`: no event is located inside steps.
  LinkCuts(const RefinementRule& rule, std::optional<double> interval,
           Refinement::Totals totals = {}, bool at_step_ends = false);
  [[nodiscard]] std::string_view name() const override { return "refinement"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] double next_time(double t) const override;
  /// Never inside a step.
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep&) const override {
    return {};
  }
  void apply(EventContext& context) override;
  void archive(const Archive& a) override {
    if (schedule_) schedule_->archive(a.part("schedule"));
    if (rule_.shortest) a("instant", instant_), a("joins", joins_);
  }

private:
  void pass(double t);

  /// Pairs are joined so often at one instant, for links that become threads only together. Of a thick jet
  /// the parts of a link that is cut may be no threads either: joining and cutting would never end.
  static constexpr std::uint64_t most_joins = 10;

  RefinementRule rule_;
  std::optional<Schedule> schedule_;
  Refinement::Totals totals_;
  bool at_step_ends_;
  double instant_ = -1;     ///< of the last joins [s]
  std::uint64_t joins_ = 0; ///< at that instant
};

} // namespace ehdjet
