#pragma once

#include "ehdjet/events/event.hpp"

#include <cstddef>
#include <optional>

namespace ehdjet {

/// A bead that reaches the collector plane x = h is frozen there. The leading bead leaves the
/// chain as soon as its upstream neighbour has landed too; until then its link still pulls with
/// its last stress. An interior bead that lands first freezes and waits (model 5).
class Landing final : public Event {
public:
  /// `collector_distance`: h [m]; `first_bead`: 1 behind a nozzle, 0 for a chain whose bead 0 is
  /// like any other.
  explicit Landing(double collector_distance, std::size_t first_bead = 1)
      : distance_(collector_distance)
      , first_bead_(first_bead) {}
  [[nodiscard]] std::string_view name() const override { return "landing"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;

private:
  void land(EventContext& context, std::size_t bead) const;
  void remove_leading(EventContext& context) const;

  template <class Reached, class Found>
  void for_each_arrival(const JetState& jet, const Reached& reached,
                        const Found& found) const;

  double distance_;
  std::size_t first_bead_;
  std::optional<std::size_t> located_; // the bead that `locate` found
};

} // namespace ehdjet
