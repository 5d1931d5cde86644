#pragma once

#include "ehdjet/events/event.hpp"

#include <cstddef>

namespace ehdjet {

/// A bead that reaches the collector plane x = h is frozen there. The leading bead leaves the
/// chain as soon as its upstream neighbour has landed too; until then its link still pulls with
/// its last stress. An interior bead that lands first freezes and waits (model 5).
class Landing final : public Event {
public:
  explicit Landing(double collector_distance) // h [m]
      : distance_(collector_distance) {}
  [[nodiscard]] std::string_view name() const override { return "landing"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;

private:
  void land(EventContext& context, std::size_t bead) const;
  void remove_leading(EventContext& context) const;

  double distance_;
  std::size_t located_ = 0; // the bead that `locate` found; 0: none
};

} // namespace ehdjet
