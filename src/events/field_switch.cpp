#include "ehdjet/events/field_switch.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {

Channel FieldSwitch::channel() const {
  return {.name = "field"};
}

std::uint64_t FieldSwitch::switches(double t) const {
  constexpr double round_off = 1e-12; // of times
  return static_cast<std::uint64_t>(std::floor(t * (1 + round_off) / half_period_));
}

bool FieldSwitch::due(const JetState& jet) const {
  return is_off(jet.time) != jet.field_is_off;
}

double FieldSwitch::next_time(double t) const {
  return static_cast<double>(switches(t) + 1) * half_period_;
}

std::optional<double> FieldSwitch::locate(const DenseStep& step) {
  if (!step.keeps_chain()) return std::nullopt; // a macro step ends there
  located_ = next_time(step.t0);
  if (located_ > step.time(1)) return std::nullopt;
  return std::min((located_ - step.t0) / step.h, 1.0);
}

std::optional<double> FieldSwitch::predict(const DenseStep& step) const {
  return (next_time(step.t0) - step.t0) / step.h;
}

void FieldSwitch::apply(EventContext& context) {
  context.jet.field_is_off = is_off(context.jet.time);
}

} // namespace ehdjet
