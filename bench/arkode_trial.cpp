// Case I with two steppers: the project's Runge-Kutta loop and SUNDIALS ARKODE (ERKStep),
// both with Dormand & Prince's 5(4) pair, on the same right-hand side, events and error scale.
//
//     arkode_trial [rtol] [end time in s]        1e-6, 0.02
//
// prints one CSV row per run:
//     own           the project's loop
//     arkode        as it comes: root mean square norm, Hermite polynomial of degree 4, which
//                   evaluates the right-hand side each time it is read
//     arkode_tuned  Hermite polynomial of degree 3; norm, controller, step size after an event
//                   and aiming at events as in the project's loop
// error_m: largest difference to a run with DOP853 at rtol 1e-12 in any coordinate of a bead,
// nan if the number of beads differs. seconds: depends on how SUNDIALS was compiled.
#include "ehdjet/events/insertion.hpp"
#include "ehdjet/events/landing.hpp"
#include "ehdjet/events/root.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <algorithm>
#include <arkode/arkode_erkstep.h>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/core.h>
#include <memory>
#include <nvector/nvector_serial.h>
#include <stdexcept>
#include <utility>

namespace {

using namespace ehdjet;
using std::array, std::size_t;
using Clock = std::chrono::steady_clock;
constexpr double never = INFINITY;
constexpr size_t none = 3;
using Result = std::pair<JetState, RunStatistics>;

Result run_own(Scene scene, const char* method, double rtol, double end) {
  scene.config.integrator.method = method;
  scene.config.integrator.rtol = rtol;
  const auto simulation = build_simulation(scene);
  simulation->run_until(end);
  return {simulation->jet(), simulation->statistics()};
}

void check(int flag) {
  if (flag < 0) throw std::runtime_error(fmt::format("ARKODE returned {}", flag));
}

std::span<double> values(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<size_t>(N_VGetLength(v))};
}

double max_norm(N_Vector x, N_Vector weight) {
  const auto a = values(x), w = values(weight);
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] * w[i]));
  return largest;
}

class ArkodeRun {
public:
  ArkodeRun(const Scene& scene, double rtol, bool tuned)
      : config_(scene.config)
      , rtol_(rtol)
      , tuned_(tuned)
      , jet_(initial_jet(scene))
      , dynamics_(build_dynamics(scene)) {
    const NozzleConfig& n = *config_.nozzle;
    const double l = n.link_length, v = config_.integrator.velocity_scale;
    scale_ = {l, l, l, v, v, v, 0.1 * config_.viscoelasticity->elastic_modulus};
    nozzle_ = {n.velocity, n.amplitude, n.angular_frequency, n.phase};
    embryo_ = {n.link_length};
    const auto born = NewBead::from(n.radius, n.link_length, n.density, n.charge_density);
    events_[0] = std::make_unique<Landing>(config_.collector->distance);
    events_[1] = std::make_unique<Release>(nozzle_, embryo_, ReleaseVelocity::half);
    events_[2] = std::make_unique<Insertion>(nozzle_, embryo_, born);
    dynamics_->bind(jet_);
    dynamics_->prescribe(0, jet_.y);
    SUNContext_Create(nullptr, &context_);
    wrap_state();
    arkode_ = ERKStepCreate(rate, 0, y_, context_);
    check(ERKStepSetUserData(arkode_, this));
    check(ERKStepWFtolerances(arkode_, weights));
    check(ERKStepSetTableNum(arkode_, ARKODE_DORMAND_PRINCE_7_4_5));
    check(ERKStepRootInit(arkode_, 3, roots));
    check(ERKStepSetRootDirection(arkode_, array{1, 1, 1}.data()));
    if (!tuned_) return;
    check(ERKStepSetInterpolantDegree(arkode_, 3));
    array<double, 3> exponents{0.85, 0.2, 0}; // fifths, see StepSizeControl
    check(ERKStepSetAdaptivityMethod(arkode_, ARK_ADAPT_PI, 0, 1, exponents.data()));
    check(ERKStepSetErrorBias(arkode_, 1));
    check(ERKStepSetSafetyFactor(arkode_, 0.9));
    check(ERKStepSetFixedStepBounds(arkode_, 1, 1));
  }
  ~ArkodeRun() { ERKStepFree(&arkode_), N_VDestroy(y_), SUNContext_Free(&context_); }

  Result run(double end) {
    const auto start = Clock::now();
    for (double expected = never; jet_.time < end; ++statistics_.steps) {
      const double t0 = jet_.time, h = restart_step_[none];
      const double ahead = 1.02 * (expected - t0);
      const bool aims = ahead > 0 && ahead < 2 * h; // as Simulation::choose_step
      const double stop = aims ? t0 + (ahead > h ? ahead / 2 : ahead) : end;
      check(ERKStepSetStopTime(arkode_, std::min(stop, end)));
      const auto g0 = event_functions(t0, y_);
      const int flag = ERKStepEvolve(arkode_, end, y_, &jet_.time, ARK_ONE_STEP);
      check(flag);
      check(ERKStepGetCurrentStep(arkode_, &restart_step_[none]));
      restart_step_[std::exchange(after_, none)] = restart_step_[none];
      expected = tuned_ && flag != ARK_ROOT_RETURN ? expected_time(t0, g0) : never;
      dynamics_->prescribe(jet_.time, jet_.y);
      apply_events(flag == ARK_ROOT_RETURN);
    }
    const std::chrono::duration<double> wall = Clock::now() - start;
    long rejected = 0;
    check(ERKStepGetNumErrTestFails(arkode_, &rejected));
    statistics_.rejected = static_cast<std::uint64_t>(rejected);
    statistics_.evaluations = dynamics_->evaluations();
    statistics_.wall_time = wall.count();
    return {jet_, statistics_};
  }

private:
  static ArkodeRun& self(void* p) { return *static_cast<ArkodeRun*>(p); }

  // Writes the nozzle's place into a vector that ARKODE lends for reading: safe only as long
  // as ERKStep builds each stage anew from y_n and the rates.
  static int rate(double t, N_Vector y, N_Vector f, void* p) {
    self(p).dynamics_->evaluate(t, values(y), values(f));
    return 0;
  }

  static int weights(N_Vector y, N_Vector weight, void* p) {
    const auto v = values(y), w = values(weight);
    const size_t rows = v.size() / self(p).scale_.size();
    for (size_t i = 0; i < v.size(); ++i)
      w[i] = 1 / (self(p).rtol_ * (self(p).scale_[i / rows] + std::abs(v[i])));
    return 0;
  }

  // Each happens when its function passes through zero; -1: not in question.
  [[nodiscard]] array<double, 3> event_functions(double t, N_Vector y) const {
    const auto r = JetColumns<const double>{values(y), jet_.beads()}.position();
    const auto distance = [&](size_t k) { return (r[k] - nozzle_.position(t)).norm(); };
    array<double, 3> g{-1, -1, -1};
    for (size_t k = jet_.first(); k < jet_.beads(); ++k)
      if (!jet_.is_landed(k)) g[0] = std::max(g[0], r.x[k] - config_.collector->distance);
    const bool embryo = jet_.has_embryo;
    if (embryo) g[1] = distance(2) - embryo_.release_distance();
    if (!embryo && !jet_.is_landed(1)) g[2] = distance(1) - embryo_.creation_distance();
    return g;
  }
  static int roots(double t, N_Vector y, double* g, void* p) {
    std::ranges::copy(self(p).event_functions(t, y), g);
    return 0;
  }

  // By parabolas through the event functions at the start, middle and end of the step.
  double expected_time(double t0, const array<double, 3>& g0) {
    const double h = jet_.time - t0;
    N_Vector y = N_VClone(y_);
    check(ERKStepGetDky(arkode_, t0 + h / 2, 0, y));
    const auto middle = event_functions(t0 + h / 2, y), g1 = event_functions(jet_.time, y_);
    N_VDestroy(y);
    double earliest = never;
    for (size_t i = 0; i < g1.size(); ++i)
      if (const auto s = expected_crossing(g0[i], g1[i], g0[i] - 4 * middle[i] + 3 * g1[i]))
        earliest = std::min(earliest, t0 + *s * h);
    return earliest;
  }

  void wrap_state() {
    if (y_) N_VDestroy(y_);
    y_ = N_VMake_Serial(static_cast<sunindextype>(jet_.y.size()), jet_.y.data(), context_);
    N_VEnableFusedOps_Serial(y_, SUNTRUE);
    if (tuned_) y_->ops->nvwrmsnorm = max_norm; // its clones inherit this
  }

  // As Simulation::apply_events.
  void apply_events(bool root) {
    array<int, 3> found{};
    if (root) check(ERKStepGetRootInfo(arkode_, found.data()));
    EventContext context{jet_, ledger_, statistics_, deposited_, refined_};
    const size_t size = jet_.y.size();
    bool any = false;
    for (size_t i = 0; i < events_.size(); ++i) {
      if (found[i] <= 0 && !events_[i]->due(jet_)) continue;
      events_[i]->apply(context);
      if (events_[i]->restarts_motion()) after_ = i;
      found[i] = 0, any = true, i = size_t(-1); // from the first again
    }
    if (!any) return;
    dynamics_->bind(jet_);
    dynamics_->prescribe(jet_.time, jet_.y);
    wrap_state();
    check(jet_.y.size() != size ? ERKStepResize(arkode_, y_, 1, jet_.time, nullptr, nullptr)
                                : ERKStepReset(arkode_, jet_.time, y_));
    if (tuned_) check(ERKStepSetInitStep(arkode_, restart_step_[after_]));
  }

  SceneConfig config_;
  double rtol_;
  bool tuned_;
  JetState jet_;
  std::unique_ptr<JetDynamics> dynamics_;
  array<double, 7> scale_{};
  Nozzle nozzle_;
  Embryo embryo_;
  array<std::unique_ptr<Event>, 3> events_; // in the order at the same instant
  array<double, 4> restart_step_{};         // per event, and the last proposal
  size_t after_ = none;                     // the event that the next step follows
  Ledger ledger_;
  RunStatistics statistics_;
  std::vector<DepositedBead> deposited_;
  std::vector<RefinementRecord> refined_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* arkode_ = nullptr;
};

double largest_difference(const JetState& a, const JetState& b) {
  if (a.beads() != b.beads()) return std::nan("");
  double largest = 0;
  for (size_t i = 0; i < 3 * a.beads(); ++i)
    largest = std::max(largest, std::abs(a.y[i] - b.y[i]));
  return largest;
}

} // namespace

int main(int argc, char** argv) {
  const double rtol = argc > 1 ? std::atof(argv[1]) : 1e-6;
  const double end = argc > 2 ? std::atof(argv[2]) : 0.02;
  const Scene scene = read_scene(EHDJET_SCENES "/pvp.toml");
  const JetState exact = run_own(scene, "dop853", 1e-12, end).first;
  fmt::print("stepper,rtol,end_s,evaluations,steps,rejected,beads,error_m,seconds\n");
  const auto print = [&](const char* stepper, const Result& r) {
    const auto& [jet, s] = r;
    fmt::print("{},{},{},{},{},{},{},{:.2e},{:.3f}\n", stepper, rtol, end, s.evaluations,
               s.steps, s.rejected, jet.beads(), largest_difference(jet, exact),
               s.wall_time);
  };
  print("own", run_own(scene, "dormand-prince", rtol, end));
  print("arkode", ArkodeRun(scene, rtol, false).run(end));
  print("arkode_tuned", ArkodeRun(scene, rtol, true).run(end));
}
