#pragma once

#include "ehdjet/core/checkpoint.hpp"

namespace ehdjet {

/// Proposes step sizes from error estimates: a PI controller.
///
///     h_new = h min(5, max(1/5, 0.9 err^-(1/q - 0.75 beta) err_old^beta)),   beta = 0.04
///
/// source : Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533; Hairer, Norsett & Wanner, II.4
class StepSizeControl {
public:
  /// `error_order`: the power q of h with which the error estimate falls.
  explicit StepSizeControl(int error_order)
      : order_(error_order) {}
  /// For an integrator that has changed its method.
  void set_error_order(int error_order) { order_ = error_order; }

  /// The next step after a step h with error <= 1.
  double after_accepted(double h, double error);
  /// The next attempt after a step h with error > 1 or not a number.
  double after_rejected(double h, double error);

  /// After an accepted step.
  void archive(const Archive& a) {
    a("previous_error", previous_error_);
    a.require("previous_error", previous_error_ > 0, "is not positive");
  }

private:
  int order_;
  double previous_error_ = 1e-4;
  bool rejected_ = false;
};

} // namespace ehdjet
