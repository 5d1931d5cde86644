#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/integrators/ode_system.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace ehdjet {

/// The result of one attempted step. A step that is too inaccurate is a result, not an error.
struct StepOutcome {
  /// Estimated error over the allowed one; 0 for a method without estimate. Accept if <= 1,
  /// which a NaN is not.
  double error = 0;
};

/// Advances a flat vector one step at a time. It does not depend on what the vector describes.
///
/// A step is attempted. Its states at any instant inside can then be read (dense output), until it
/// is committed, or attempted again from the same state with another h.
class Integrator {
public:
  virtual ~Integrator() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;
  /// The method of the last attempt, if the integrator chooses among methods; otherwise its name.
  [[nodiscard]] virtual std::string_view method_in_use() const { return name(); }
  [[nodiscard]] virtual int order() const = 0;
  /// The last attempt's error estimate falls with h to this power; 0 if there is none.
  [[nodiscard]] virtual int error_order() const = 0;

  /// Tries y(t) -> y(t + h). `y` must stay where it is until the step is committed; its prescribed
  /// components have their values at t.
  virtual StepOutcome attempt(OdeSystem& system, double t, double h,
                              std::span<const double> y) = 0;
  /// The state at t + h of the last attempt.
  [[nodiscard]] virtual std::span<const double> end_state() const = 0;
  /// Component where the last attempt's error was largest or not a number.
  [[nodiscard]] virtual std::size_t worst_component() const = 0;

  /// Must be called once before `dense_output` of an attempt; evaluates the stages still missing.
  virtual void prepare_dense_output(OdeSystem& system) = 0;
  /// Components [first, first + out.size()) at t + theta h, 0 <= theta <= 1.
  virtual void dense_output(double theta, std::size_t first,
                            std::span<double> out) const = 0;

  /// Makes the end of the last attempt the state: swaps it into `y`.
  virtual void commit(std::vector<double>& y) = 0;
  /// f at the end of the last attempt, valid until the next one or `commit`; empty if the method
  /// does not evaluate it.
  [[nodiscard]] virtual std::span<const double> end_rate() const { return {}; }
  /// What f(t, y) is at the start of the next attempt, if the method can make use of it. To be called
  /// after `restart`.
  virtual void start_from_rate(std::span<const double> /*rate*/) {}
  /// Forgets what is known about f(t, y). To be called after anything but `commit` has changed y.
  virtual void restart() = 0;
  /// What the next steps depend on. Reading is followed by an attempt from the state that the checkpoint
  /// has.
  virtual void archive(const Archive& /*a*/) {}

  /// A first step that changes no component by more than a hundredth of its error scale's size
  /// (after Hairer, Norsett & Wanner, II.4).
  virtual double initial_step(OdeSystem& system, double t, std::span<const double> y) = 0;
};

} // namespace ehdjet
