#include "ehdjet/integrators/auto_integrator.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/integrators/stability_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ehdjet {
namespace {

constexpr std::string_view explicit_method = "dormand-prince";
constexpr int steps_between_looks = 8;
// After each event steps are short for a while, also where nothing is stiff. They are not compared.
constexpr int looks_to_leave_explicit = 3, first_patience = 24, most_patience = 1 << 20;
constexpr double leave_explicit = 0.7, leave_implicit = 0.25;
// The first step is a cautious guess; accuracy allows longer steps later.
constexpr double start_implicit = 1;

double least_stable_radius(const ButcherTableau& method) {
  constexpr int directions = 18;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= directions; ++i)
    least = std::min(
        least,
        longest_stable_step(method, {-std::sin(0.5 * std::numbers::pi * i / directions),
                                     std::cos(0.5 * std::numbers::pi * i / directions)}));
  return least;
}

} // namespace

AutoIntegrator::AutoIntegrator(const ErrorScale& scale)
    : explicit_(butcher_tableau(explicit_method), scale)
    , implicit_(rosenbrock_tableaus().front(), scale)
    , active_(&explicit_)
    , surely_stable_(least_stable_radius(butcher_tableau(explicit_method)))
    , steps_to_look_(steps_between_looks)
    , patience_(first_patience) {}

bool AutoIntegrator::longer_than(double share, double h, const StiffPart& stiff) const {
  const StiffPart::Modes modes = stiff.fastest_modes();
  double fastest = 0;
  for (const auto& s : modes) fastest = std::max(fastest, std::abs(s));
  if (h * fastest <= share * surely_stable_) return false;
  if (!std::isfinite(fastest)) return true;
  return std::ranges::any_of(modes, [&](const std::complex<double>& s) {
    return h > share * longest_stable_step(butcher_tableau(explicit_method), s);
  });
}

void AutoIntegrator::change_to(Integrator& method) {
  active_ = &method;
  active_->restart();
  in_a_row_ = 0, steps_to_look_ = steps_between_looks, steps_ = 0;
}

void AutoIntegrator::choose(OdeSystem& system, double t, double h,
                            std::span<const double> y) {
  chosen_ = true;
  StiffPart* stiff = system.stiff_part();
  EHDJET_EXPECTS(stiff != nullptr);
  stiff->linearize(t, y);
  if (longer_than(start_implicit, h, *stiff)) change_to(implicit_);
}

void AutoIntegrator::reconsider(OdeSystem& system, double t, std::span<const double> y) {
  ++steps_;
  if (--steps_to_look_ > 0 && !rejected_) return;
  rejected_ = false;
  StiffPart& stiff = *system.stiff_part();
  stiff.linearize(t, y);
  const bool is_explicit = active_ == &explicit_;
  const bool change = is_explicit ? longer_than(leave_explicit, accepted_, stiff)
                                  : !longer_than(leave_implicit, accepted_, stiff);
  steps_to_look_ = change ? 1 : steps_between_looks;
  in_a_row_ = change ? in_a_row_ + 1 : 0;
  if (in_a_row_ < (is_explicit ? looks_to_leave_explicit : patience_)) return;
  // If the implicit method is needed again so soon, it is left later the next time.
  if (is_explicit && left_implicit_ && steps_ < 4 * patience_)
    patience_ = std::min(2 * patience_, most_patience);
  left_implicit_ = !is_explicit;
  if (is_explicit)
    change_to(implicit_);
  else
    change_to(explicit_);
}

StepOutcome AutoIntegrator::attempt(OdeSystem& system, double t, double h,
                                    std::span<const double> y) {
  if (!chosen_) {
    choose(system, t, h, y);
  } else if (new_step_) {
    reconsider(system, t, y);
  }
  new_step_ = false;
  const StepOutcome outcome = active_->attempt(system, t, h, y);
  if (outcome.error <= 1)
    accepted_ = h;
  else
    rejected_ = true;
  return outcome;
}

void AutoIntegrator::commit(std::vector<double>& y) {
  active_->commit(y);
  new_step_ = true;
}

void AutoIntegrator::restart() {
  active_->restart();
  new_step_ = true;
}

void AutoIntegrator::start_from_rate(std::span<const double> rate) {
  active_->start_from_rate(rate);
}

void AutoIntegrator::archive(const Archive& a) {
  bool is_implicit = active_ == &implicit_;
  a("is_implicit", is_implicit);
  active_ = &explicit_;
  if (is_implicit) active_ = &implicit_;
  a("chosen", chosen_), a("rejected", rejected_), a("accepted", accepted_);
  a("steps_to_look", steps_to_look_), a("in_a_row", in_a_row_);
  a("patience", patience_), a("steps", steps_), a("left_implicit", left_implicit_);
  a.require("accepted", accepted_ >= 0, "is negative");
  a.require("patience", patience_ >= first_patience && patience_ <= most_patience,
            "is out of range");
  explicit_.archive(a.part("explicit")); // the implicit method keeps nothing between steps
}

double AutoIntegrator::initial_step(OdeSystem& system, double t,
                                    std::span<const double> y) {
  return active_->initial_step(system, t, y);
}

} // namespace ehdjet
