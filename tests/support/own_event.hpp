#pragma once

#include "ehdjet/events/event.hpp"

namespace ehdjet::test {

/// An event of a program that uses the library: at a given time all beads lose a part of their
/// charge.
class Discharge final : public Event {
public:
  Discharge(double time, double part) // [s], [-]
      : time_(time)
      , part_(part) {}
  [[nodiscard]] std::string_view name() const override { return "discharge"; }
  [[nodiscard]] bool due(const JetState& jet) const override {
    return !done_ && jet.time >= time_;
  }
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override {
    if (done_ || step.time(1) < time_) return std::nullopt;
    return (time_ - step.t0) / step.h;
  }
  [[nodiscard]] std::optional<double> scheduled_time() const override { return time_; }
  [[nodiscard]] std::optional<double> predict(const DenseStep&) const override {
    return {};
  }
  void apply(EventContext& context) override {
    for (double& q : context.jet.charge) q *= 1 - part_;
    done_ = true;
  }

private:
  double time_, part_;
  bool done_ = false;
};

} // namespace ehdjet::test
