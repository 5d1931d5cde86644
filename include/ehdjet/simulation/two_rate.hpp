#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/dense_step.hpp"
#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/jet/inflow.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/multirate/extrapolated_field.hpp"
#include "ehdjet/multirate/inner_record.hpp"
#include "ehdjet/multirate/predictor.hpp"
#include "ehdjet/multirate/projected_field.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

class Simulation;

/// Macro steps of a jet whose beads near the nozzle are fast (model 6.1).
///
/// Only about the first centimetre of a jet is fast: its beads need steps of 10 us, and beads are born
/// there every 80 us, while all others could do with steps of 300 us. So the chain is cut in two:
///
///     inner beads      0 ... m-1, a small `Simulation` of its own with micro steps and births. It goes
///                      first. Downstream beads are where a predictor puts them
///     downstream beads m ... n, one step of the ordinary integrator and Coulomb solver, under the field
///                      of the inner beads projected on polynomials in time
///
/// Within a macro step the chain keeps the numbers that it has at the start, whatever has been born; the
/// step is committed with the new chain as a whole.
///
/// cost   : seven evaluations of the downstream beads per macro step, of which the first one is known
///          from the step before, and some thousand of the few inner beads per millisecond
/// source : Rice, J. Res. NBS 64B (1960) 151; Gear & Wells, BIT 24 (1984) 484 (fastest first)
class TwoRate {
public:
  struct Options {
    std::size_t inner_beads = 24; ///< m
    double rtol = 1e-5;           ///< of the inner beads
    bool adapts = true; ///< m grows where the beads around it limit the macro step
    std::size_t fewest_beads = 0;          ///< a shorter chain has one rate
    std::optional<double> collector = {};  ///< its distance [m]
    double longest = 4e-4;                 ///< macro step [s]
    std::optional<double> decay_time = {}; ///< of charges on an insulating collector [s]
  };
  /// How the two parts move. `inner`: with the events of the inflow; its equations of motion have `field`
  /// among their terms. `downstream` has `projected` among its terms.
  struct Parts {
    std::unique_ptr<Simulation> inner;
    JetDynamics* inner_dynamics = nullptr; ///< of `inner`
    std::unique_ptr<JetDynamics> downstream;
    std::unique_ptr<Integrator> integrator;
    ErrorScale scale; ///< of the integrator
    std::unique_ptr<CoulombSolver> inward,
        outward; ///< Coulomb sums at the inner and the
                 ///< downstream beads, exact
    std::shared_ptr<const Inflow> inflow;
    std::shared_ptr<ExtrapolatedField> field;
    std::shared_ptr<ProjectedField> projected;
    std::shared_ptr<Predictor> predictor;
    std::shared_ptr<InnerRecord> record;
  };
  TwoRate(Parts parts, const Options& options);
  ~TwoRate();

  /// Whether a chain is long enough to be cut in two, or to stay so if it is `in_use`.
  [[nodiscard]] bool suits(const JetState& jet, bool in_use) const;
  [[nodiscard]] double longest_step() const { return options_.longest; }
  /// Beads pass it within a step; none: there is no collector [m].
  [[nodiscard]] std::optional<double> collector() const { return options_.collector; }

  /// Tries a macro step of length h [s]. `jet` and `ledger` must stay as they are until it is committed.
  /// errors : RunError of the inner beads
  StepOutcome attempt(const JetState& jet, const Ledger& ledger, double h);
  /// As that of `Simulation`.
  void between_attempts(const std::function<void()>& hook);
  /// Of the downstream part: error order, end state, worst component.
  [[nodiscard]] const Integrator& integrator() const { return *parts_.integrator; }
  /// The last attempt. The integrator evaluates what is still missing for dense output.
  [[nodiscard]] std::unique_ptr<DenseStep> step(const JetState& jet);
  /// Makes the end of the last attempt the jet, with all that has been born.
  void commit(JetState& jet, Ledger& ledger, RunStatistics& statistics);

  /// After an event has changed the chain. `only_end`: it took beads off the end that did not move.
  void chain_changed(const JetState& jet, bool only_end);
  /// Forgets what is carried over from the last step; the next one computes it anew.
  void forget() { ready_ = false; }
  void count(RunStatistics& statistics) const;
  /// `jet`: the chain at the time of the checkpoint.
  void archive(const Archive& a, const JetState& jet);

private:
  class Step;

  [[nodiscard]] std::uint64_t downstream_evaluations() const {
    return downstream_before_ + parts_.downstream->evaluations();
  }

  void prepare(const JetState& jet);
  void evaluate_alone(const JetState& jet);
  void bind_downstream(const JetState& jet);
  void set_rate(const JetState& jet);
  void rest_landed(const JetState& jet, std::vector<double>& rate) const;
  void prepare_inner(const JetState& jet, const Ledger& ledger);
  bool run_inner(double end);
  void take_back_inner(double end);
  void learn_distant_field();
  void add_mat(Vec3View places, double t);
  void add_field_of(const JetState& chain, std::size_t first, std::size_t last,
                    ConstVec3View targets, Vec3View field);
  [[nodiscard]] double mismatch() const;
  void project(const JetState& jet, double h);
  void carry_over(const JetState& jet, const JetState& next, std::size_t births);
  void forget_distant(const JetState& next, std::size_t births);
  bool adapt(std::size_t worst, std::size_t births);

  Parts parts_;
  Options options_;
  std::size_t inner_beads_;      // m
  bool mismatch_limits_ = false; // the length of the last attempt
  int failures_ = 0;             // of the inner beads, in a row
  std::size_t near_cut_ = 0,
              steps_in_window_ = 0; // macro steps that the beads around m limit
  double h_ = 0, start_ = 0;        // of the last attempt [s]

  // At the start of the step, of the chain as it is then.
  bool ready_ = false;              // what follows is known
  bool inner_ready_ = false;        // and the inner chain stands there
  std::vector<double> alone_;       // rates of the downstream beads without the inner ones
  std::vector<double> rate_, jerk_; // all together, and how it changes per second
  std::vector<ExtrapolatedField> field_before_; // each piece of the record
  const JetState* jet_ = nullptr;
  std::size_t distant_ =
      0; // first bead of the chain that acts on the inner ones by extrapolation

  std::vector<double> buffer_, places_, ones_, start_rate_, previous_, charge_;
  JetState inner_chain_;
  std::uint64_t inner_evaluations_ = 0;
  std::uint64_t macro_steps_ = 0;
  std::uint64_t downstream_before_ =
      0;                 // evaluations before the checkpoint that the run goes on from
  double full_sums_ = 0; // Coulomb pairs over all pairs of the chain
  double pairs_ = 0;     // between the parts, in this macro step
};

} // namespace ehdjet
