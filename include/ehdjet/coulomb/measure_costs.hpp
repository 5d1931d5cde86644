#pragma once

#include "ehdjet/coulomb/cost_model.hpp"

#include <cstddef>
#include <functional>

namespace ehdjet {

/// One timing of `measure_costs`.
struct CostTiming {
  std::size_t number, all; ///< this one of how many
  double spread; ///< median over best of its calls; far above 1 if they were disturbed
};

/// What CostModel::measured gives. `watch` is called after each timing; it may throw to end the measurement.
CostModel measure_costs(SimdLevel level,
                        const std::function<void(const CostTiming&)>& watch);

} // namespace ehdjet
