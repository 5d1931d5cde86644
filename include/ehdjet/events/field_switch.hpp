#pragma once

#include "ehdjet/events/event.hpp"

#include <cstdint>
#include <optional>

namespace ehdjet {

/// A field of a square wave is switched at the multiples of half a period: on while
///
///     sin(2 pi f t) > 0                                                           (model 2.6)
///
/// The state of the switch belongs to the jet, so that the field is constant within every step.
class FieldSwitch final : public Event {
public:
  explicit FieldSwitch(double frequency) // f [1/s]
      : half_period_(1 / (2 * frequency)) {}
  [[nodiscard]] std::string_view name() const override { return "field switch"; }
  [[nodiscard]] Channel channel() const override; ///< that of the field
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] double next_time(double t) const override;
  [[nodiscard]] std::optional<double> scheduled_time() const override { return located_; }
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;

private:
  /// How many switches there have been until time t, the one at t included.
  [[nodiscard]] std::uint64_t switches(double t) const;
  [[nodiscard]] bool is_off(double t) const { return switches(t) % 2 == 1; }

  double half_period_; // [s]
  double located_ = 0; // [s]
};

} // namespace ehdjet
