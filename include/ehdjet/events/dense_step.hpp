#pragma once

#include "ehdjet/integrators/integrator.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

class Event;

/// A step that was taken but not yet committed, readable at any instant t0 + theta h.
///
/// All of it but `chain_at` refers to the beads of the chain at the start of the step and to their
/// numbers there, also in a step inside which beads are born.
class DenseStep {
public:
  DenseStep(double start, double length, const JetState& chain)
      : t0(start)
      , h(length)
      , jet(chain) {}
  virtual ~DenseStep() = default;
  DenseStep(const DenseStep&) = delete;
  DenseStep& operator=(const DenseStep&) = delete;

  double t0, h;        ///< [s]
  const JetState& jet; ///< the chain at t0

  [[nodiscard]] double time(double theta) const { return t0 + theta * h; }
  /// Position and velocity of a bead that is integrated (not the nozzle, not an embryo).
  [[nodiscard]] Vec3 position(double theta, std::size_t bead) const {
    return vector(theta, 0, bead);
  }
  [[nodiscard]] Vec3 velocity(double theta, std::size_t bead) const {
    return vector(theta, 3, bead);
  }
  /// Any integrated column.
  [[nodiscard]] double value(double theta, std::size_t column, std::size_t bead) const {
    return component(theta, column * jet.beads() + bead);
  }
  [[nodiscard]] double x(double theta, std::size_t bead) const {
    return component(theta, bead);
  }
  /// x of all beads at t0 + h.
  [[nodiscard]] virtual std::span<const double> end_x() const = 0;
  /// The whole state; prescribed beads are not put in their places.
  virtual void state(double theta, std::span<double> out) const = 0;

  /// Whether the inflow's events end steps. Otherwise beads are born inside the step, and events that
  /// happen at given times have their time at its end.
  [[nodiscard]] virtual bool keeps_chain() const { return true; }
  /// Brings `seen`, a copy of the chain at t0, to t0 + theta h; with the beads that have been born
  /// by the time `past`, in a step inside which beads are born.
  virtual void chain_at(double theta, double /*past*/, JetState& seen) const {
    seen.time = time(theta);
    state(theta, seen.y);
  }
  /// What the ledger of the chain at t0 becomes by the time `past`.
  virtual void ledger_at(double /*past*/, Ledger& /*ledger*/) const {}
  /// By how much the beads' numbers have grown by then.
  [[nodiscard]] virtual std::size_t births(double /*past*/) const { return 0; }

  /// A time inside the step at which the motion has a kink, and what happens then, if anything.
  struct InnerTime {
    double time = 0;              ///< [s]
    const Event* event = nullptr; ///< none: only a kink
  };
  /// Appends the inner times of the step itself.
  virtual void list_inner_times(std::vector<InnerTime>& /*times*/) const {}

protected:
  [[nodiscard]] virtual double component(double theta, std::size_t index) const = 0;

private:
  [[nodiscard]] Vec3 vector(double theta, std::size_t column, std::size_t bead) const {
    const std::size_t n = jet.beads(), i = column * n + bead;
    return {component(theta, i), component(theta, i + n), component(theta, i + 2 * n)};
  }
};

/// The step of an integrator. Dense output is only prepared if a state inside the step is read.
class IntegratorStep final : public DenseStep {
public:
  IntegratorStep(double start, double length, const JetState& chain, Integrator& integrator,
                 OdeSystem& system)
      : DenseStep(start, length, chain)
      , integrator_(integrator)
      , system_(system) {}

  [[nodiscard]] std::span<const double> end_x() const override {
    return integrator_.end_state().first(jet.beads());
  }
  void state(double theta, std::span<double> out) const override;

private:
  [[nodiscard]] double component(double theta, std::size_t index) const override;

  Integrator& integrator_;
  OdeSystem& system_;
};

/// What the step of several jets together is for one of them: its rows of the common columns.
class RowsOfStep final : public DenseStep {
public:
  /// `all_rows`: how many rows each column of the integrator's state has.
  RowsOfStep(double start, double length, const JetState& chain, Integrator& integrator,
             OdeSystem& system, std::size_t first_row, std::size_t all_rows)
      : DenseStep(start, length, chain)
      , integrator_(integrator)
      , system_(system)
      , first_(first_row)
      , all_(all_rows) {}

  [[nodiscard]] std::span<const double> end_x() const override {
    return integrator_.end_state().subspan(first_, jet.beads());
  }
  void state(double theta, std::span<double> out) const override;

private:
  [[nodiscard]] double component(double theta, std::size_t index) const override;
  void read(double theta, std::size_t index, std::span<double> out) const;

  Integrator& integrator_;
  OdeSystem& system_;
  std::size_t first_, all_;
};

} // namespace ehdjet
