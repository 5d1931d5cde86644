#pragma once

#include "ehdjet/integrators/rosenbrock_w.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <vector>

namespace ehdjet {

/// Dormand & Prince's explicit pair while accuracy limits the step; ROS34PW2 while stability would.
///
/// The step is compared with the stability limit of the fastest modes of the system's stiff part,
/// every eighth step and after a rejection; a comparison costs one linearization. The explicit
/// method is left when its steps are longer than 0.7 of the limit in several comparisons in a row,
/// the implicit one when its steps are shorter than a quarter of it. The latter takes more
/// comparisons in a row each time the implicit method is needed again soon afterwards. As long as
/// the explicit method is not left, every bit is the same as with that method alone.
class AutoIntegrator final : public Integrator {
public:
  explicit AutoIntegrator(const ErrorScale& scale);

  [[nodiscard]] std::string_view name() const override { return "auto"; }
  [[nodiscard]] std::string_view method_in_use() const override { return active_->name(); }
  [[nodiscard]] int order() const override { return active_->order(); }
  [[nodiscard]] int error_order() const override { return active_->error_order(); }

  StepOutcome attempt(OdeSystem& system, double t, double h,
                      std::span<const double> y) override;
  [[nodiscard]] std::span<const double> end_state() const override {
    return active_->end_state();
  }
  [[nodiscard]] std::size_t worst_component() const override {
    return active_->worst_component();
  }
  void prepare_dense_output(OdeSystem& system) override {
    active_->prepare_dense_output(system);
  }
  void dense_output(double theta, std::size_t first, std::span<double> out) const override {
    active_->dense_output(theta, first, out);
  }
  void commit(std::vector<double>& y) override;
  [[nodiscard]] std::span<const double> end_rate() const override {
    return active_->end_rate();
  }
  void start_from_rate(std::span<const double> rate) override;
  void restart() override;
  void archive(const Archive& a) override;
  double initial_step(OdeSystem& system, double t, std::span<const double> y) override;

private:
  void choose(OdeSystem& system, double t, double h, std::span<const double> y);
  void reconsider(OdeSystem& system, double t, std::span<const double> y);
  void change_to(Integrator& method);
  [[nodiscard]] bool longer_than(double share, double h, const StiffPart& stiff) const;

  RungeKutta explicit_;
  RosenbrockW implicit_;
  Integrator* active_;
  double surely_stable_; // |s| h up to which the explicit method damps every mode
  bool chosen_ = false;
  bool new_step_ = true;
  bool rejected_ = false;
  double accepted_ = 0; // length of the last accepted step [s]
  int steps_to_look_, in_a_row_ = 0;
  int patience_;               ///< comparisons in a row until the implicit method is left
  int steps_ = 0;              ///< since the last change of method
  bool left_implicit_ = false; ///< by that change
};

} // namespace ehdjet
