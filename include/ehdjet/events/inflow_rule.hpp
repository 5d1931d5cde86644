#pragma once

#include "ehdjet/events/event.hpp"
#include "ehdjet/jet/inflow.hpp"

#include <memory>
#include <vector>

namespace ehdjet {

/// An inflow with the events that make its beads.
class InflowRule : public Inflow {
public:
  using Inflow::Inflow;
  /// In the order in which they are applied at one instant. The inflow outlives them.
  [[nodiscard]] virtual std::vector<std::unique_ptr<Event>> events() const = 0;
};

} // namespace ehdjet
