#pragma once

#include "ehdjet/events/inflow_rule.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

/// The inflow of a pump: fluid enters link 1 at the rate Q, whatever the forces do (model 4.3). Bead 1
/// moves freely; what it carries is a function of time:
///
///     V_1 = V0/2 + Q (t - t_b),   m_1 = rho V_1,   q_1 = rho_q V_1,   V0 = pi a0^2 l_step
///
/// At t_b + V0/Q link 1 is cut. Bead 0 carries no charge: that of the fluid in the nozzle is a
/// force term (`NozzleThread`).
class PumpInflow final : public InflowRule {
public:
  struct Rule {
    double link_length = 0;    ///< l_step [m]
    Feed feed;                 ///< Q, rho, A0, sigma_in
    double charge_density = 0; ///< rho_q [C/m^3]
  };
  /// The fluid velocity of the nozzle is Q/A0.
  PumpInflow(Nozzle nozzle, const Rule& rule);

  /// V0/Q: the time between cuts [s].
  [[nodiscard]] double period() const;
  /// The time of the cut that follows the one at `since` [s].
  [[nodiscard]] double next_cut(double since) const;
  [[nodiscard]] const Rule& rule() const { return rule_; }

  [[nodiscard]] JetState start(std::shared_ptr<const BeadTable> table) const override;
  void prescribe(double t, bool has_led_bead, JetColumns<double> y) const override;
  [[nodiscard]] bool changes_content(bool /*has_led_bead*/) const override { return true; }
  [[nodiscard]] LinkContent acting(const LinkContent& full, double since, double t,
                                   ConstVec3View r) const override;
  [[nodiscard]] LinkContent content_rate(const LinkContent& full,
                                         JetColumns<const double> y) const override;
  [[nodiscard]] Vec3 led_velocity(JetColumns<const double> y) const override;
  [[nodiscard]] std::optional<Feed> feed() const override { return rule_.feed; }
  [[nodiscard]] std::vector<std::unique_ptr<Event>> events() const override;

private:
  [[nodiscard]] LinkContent of(double volume) const;

  Rule rule_;
};

/// Link 1 is cut at a time that is known in advance. The new bead stands at a third of the link, its
/// link has the volume V0/2 and the one of the old bead V0. Both links keep the stress. The new bead
/// has the velocity of the fluid there, between (Q/A_1) t_1 + w0 at the nozzle and that of the old
/// bead (model 4.3).
/// errors : RunError if fluid piles up at the nozzle: a link near it is thicker than twice the
///          section of the nozzle, or one of the first beads moves back
class FeedCut final : public Event {
public:
  /// `inflow` outlives the event.
  explicit FeedCut(const PumpInflow& inflow)
      : inflow_(inflow) {}
  [[nodiscard]] std::string_view name() const override { return "insertion"; }
  [[nodiscard]] Channel channel() const override;
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> scheduled_time() const override { return located_; }
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;

private:
  void check_flow(const JetState& jet) const;

  const PumpInflow& inflow_;
  double located_ = 0; // the cut that ends the step [s]
};

} // namespace ehdjet
