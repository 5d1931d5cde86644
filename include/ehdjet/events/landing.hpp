#pragma once

#include "ehdjet/events/event.hpp"
#include "ehdjet/jet/plate.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ehdjet {

/// A bead that reaches the collector plane x = h is frozen there. The leading bead leaves the
/// chain as soon as its upstream neighbour has landed too; until then its link still pulls with
/// its last stress. An interior bead that lands first freezes and waits (model 5).
///
/// The link to a resting bead may become so short that it is no thread any more, on a straight jet,
/// whose beads all land in one place: once it is shorter than its radius, l^3 <= V/pi, and than a tenth
/// of its length when the lower bead landed, its upper bead has landed, too.
///
/// The collector may move in its plane and takes landed beads along (model 5.1).
///
/// A landing ends the step, unless beads land every few steps. Then they pass the collector during
/// a step, in which they count as resting where they crossed (JetState::absorbing_plane); time and
/// state of each bead at its landing are read off the dense output, and the chain changes at the
/// end of the step. What that does to the motion is part of the error estimate.
class Landing final : public Event {
public:
  struct Options {
    std::size_t first_bead = 1;            ///< 0 for a chain whose bead 0 is like any other
    bool may_pass = false;                 ///< steps need not end at frequent landings
    bool charges_mat = false;              ///< charges stay on the collector (model 5.2)
    std::optional<double> decay_time = {}; ///< of those charges [s]
    /// So many jets take common steps, each of which would end at a landing of any of them.
    std::size_t jets = 1;
  };
  Landing(const Plate& plate, const Options& options)
      : plate_(plate)
      , options_(options) {}
  [[nodiscard]] std::string_view name() const override { return "landing"; }
  [[nodiscard]] Channel channel() const override;
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  void overtaken(double time) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void anticipate(double t, JetState& jet) const override;
  void list_inner_times(std::vector<double>& times) const override;
  void apply(EventContext& context) override;
  /// Beads that passed within the step had landed for the others by then.
  [[nodiscard]] bool leaves_motion() const override { return only_passed_; }
  void archive(const Archive& a) override {
    a("steps_per_landing", steps_per_landing_), a("last_step", last_step_);
    a.require("steps_per_landing", steps_per_landing_ >= 0, "is negative");
  }

private:
  /// How close a bead has to come to a resting bead below it to land there; 0: none rests [m].
  [[nodiscard]] static double touching_distance(const JetState& jet, std::size_t bead);

  /// A bead at the collector. Beads may be born while it is on record: they change its number, but not
  /// its distance from the end of the chain.
  struct Arrival {
    std::size_t from_end = 0;          ///< of the chain at the start of the step
    double time = 0;                   ///< [s]
    std::vector<double> state;         ///< its integrated columns
    std::optional<double> link_length; ///< absent: that of the jet as it is [m]
  };

  [[nodiscard]] std::optional<double> first_touch(const DenseStep& step) const;
  [[nodiscard]] bool has_arrived(const JetState& jet, std::size_t bead) const;
  [[nodiscard]] Arrival arrival_inside(const DenseStep& step, std::size_t bead,
                                       double theta) const;
  [[nodiscard]] Arrival arrival_now(const JetState& jet, std::size_t from_end) const;
  [[nodiscard]] std::vector<Arrival> arrivals(const JetState& jet) const;
  void put_on_collector(JetState& jet, std::size_t bead, const Arrival& arrival,
                        double t) const;
  void remove_leading(EventContext& context, double time) const;
  void leave_chain(JetState& jet, double time) const;
  void keep_pace(EventContext& context, std::size_t landings);

  template <class Reached, class Found>
  void for_each_arrival(const JetState& jet, const Reached& reached,
                        const Found& found) const;

  Plate plate_;
  Options options_;
  std::optional<std::size_t>
      located_;                    // the bead that ends the step, from the end of the chain
  bool only_passed_ = false;       // those that landed last
  std::vector<Arrival> passing_;   // beads that do not, in the order of their landing
  double steps_per_landing_ = 100; // recent average
  std::uint64_t last_step_ = 0;
};

} // namespace ehdjet
