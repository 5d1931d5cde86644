#pragma once

#include "ehdjet/dynamics/acting_chain.hpp"
#include "ehdjet/events/dense_step.hpp"
#include "ehdjet/jet/inflow.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/observer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace ehdjet {

/// How the inner beads move within one macro step: the dense output of each of their micro steps,
/// with the chain as it was in it. It guides the inner beads of the downstream equations of motion.
///
/// Beads that are born within the macro step shift the numbers of the others. "Row" is a number in the
/// chain at the start of the macro step.
///
/// memory : five states per micro step. The dense output of Dormand & Prince's pair is a polynomial of
///          degree 4, that of ROS34PW2 of degree 3, so that five values give it exactly
class InnerRecord final : public Observer, public Guide {
public:
  static constexpr std::size_t samples = 5;

  /// One micro step.
  struct Piece {
    double begin = 0, end = 0;      ///< [s]
    JetState chain;                 ///< at its begin
    Ledger ledger;                  ///< at its begin
    std::size_t births = 0;         ///< in the macro step before it
    const Event* closing = nullptr; ///< what happened at its end, if anything
    std::array<std::vector<double>, samples> state; ///< at equal distances
  };

  explicit InnerRecord(std::shared_ptr<const Inflow> inflow)
      : inflow_(std::move(inflow)) {}
  /// Begins the record of a macro step whose first `rows` beads are the inner ones. The inner chain has
  /// that many `beads` now; `ledger` is what it keeps.
  void begin(std::size_t rows, std::size_t beads, const Ledger& ledger);
  /// Drops all micro steps but the first ones.
  void keep(std::size_t pieces) { used_ = std::min(used_, pieces); }
  /// The micro steps, ascending in time.
  [[nodiscard]] std::span<const Piece> pieces() const { return {pieces_.data(), used_}; }
  /// The micro step at that time; right at an event, the one after it.
  [[nodiscard]] const Piece& at(double t) const;

  /// The chain of a micro step at a time inside it, with the nozzle and an embryo in their places.
  void chain_at(const Piece& piece, double t, JetState& chain) const;
  /// Any integrated column of a bead that was there at the start.
  [[nodiscard]] double value(double t, std::size_t column, std::size_t row) const;
  /// Puts all inner beads that were there at the start in their places.
  void prescribe(double t, JetColumns<double> y) const override;

  [[nodiscard]] Interest interest() const override { return {.steps_and_events = true}; }
  void begin_step(const DenseStep& step,
                  std::span<const std::unique_ptr<Event>> events) override;
  void end_step(double t, double theta) override;
  void before_event(const Event& event, const JetState& jet) override;
  void after_event(const Event& event, const JetState& jet) override;

private:
  Piece& add_piece();

  std::shared_ptr<const Inflow> inflow_;
  const Ledger* ledger_ = nullptr;
  std::size_t rows_ = 0, beads_at_start_ = 0;
  std::vector<Piece> pieces_; // reused: only the first `used_` belong to the step
  std::size_t used_ = 0;
  const DenseStep* step_ = nullptr; // in progress
};

} // namespace ehdjet
