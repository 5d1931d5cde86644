#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <limits>
#include <span>

namespace ehdjet {

/// J, the part of df/dy that makes a system stiff, at one state. A term that J leaves out costs a
/// W-method stability but never order, so that J may contain only what is local and cheap.
class StiffPart {
public:
  virtual ~StiffPart() = default;
  /// J at (t, y). Prescribed components of y stand at their values at t.
  virtual void linearize(double t, std::span<const double> y) = 0;
  /// Prepares `solve` for one eta = gamma h [s].
  virtual void factorize(double eta) = 0;
  /// x <- (I - eta J)^-1 x. Entries of components with rate zero must be zero, and stay so.
  virtual void solve(std::span<double> x) const = 0;
  /// out += factor J dp/dt, where p are the components that the system prescribes: how f
  /// changes because they move.
  virtual void add_time_derivative(double factor, std::span<double> out) const = 0;
  /// Estimates of the fastest mode of J of each kind (relaxation, elasticity, tension), with
  /// Re <= 0 and Im >= 0; 0 if there is none [1/s].
  using Modes = std::array<std::complex<double>, 3>;
  [[nodiscard]] virtual Modes fastest_modes() const = 0;
};

/// dy/dt = f(t, y). Components that the system prescribes as functions of time (the nozzle, an
/// embryo) have rate zero.
class OdeSystem {
public:
  virtual ~OdeSystem() = default;
  /// Overwrites the prescribed components of y with their values at t. An integrator calls this
  /// for each state that it makes, before it evaluates f there.
  virtual void prescribe(double /*t*/, std::span<double> /*y*/) const {}
  virtual void evaluate(double t, std::span<const double> y, std::span<double> rate) = 0;
  /// How many rows of each column of y count in the error of a step that ends at `end`: what the
  /// rows behind them do from there on does not matter.
  [[nodiscard]] virtual std::size_t judged_rows(std::span<const double> /*end*/) const {
    return std::numeric_limits<std::size_t>::max();
  }
  /// For implicit methods; null if the system has no such part.
  [[nodiscard]] virtual StiffPart* stiff_part() { return nullptr; }
};

} // namespace ehdjet
