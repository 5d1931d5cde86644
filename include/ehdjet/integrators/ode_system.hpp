#pragma once

#include <span>

namespace ehdjet {

/// dy/dt = f(t, y). Components that the system prescribes as functions of time (the nozzle, an
/// embryo) have rate zero, and `evaluate` overwrites them in `y` with their values at t.
class OdeSystem {
public:
  virtual ~OdeSystem() = default;
  virtual void evaluate(double t, std::span<double> y, std::span<double> rate) = 0;
};

} // namespace ehdjet
