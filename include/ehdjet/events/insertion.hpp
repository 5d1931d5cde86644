#pragma once

#include "ehdjet/events/inflow_rule.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

/// Every k-th bead differs: an impurity that makes the jet varicose (model 4).
struct Varicosity {
  std::uint64_t every = 1;                 ///< k, counted with the bead of the start
  double volume = 1, mass = 1, charge = 1; ///< factors f
};

/// Velocity that a released bead starts with (model 4.2).
enum class ReleaseVelocity {
  half,  ///< ((v_2x - v_s)/2 + v_s, v_2y/2, v_2z/2), the paper's
  nozzle ///< (v_s, 0, 0)
};

/// The inflow of the paper: fluid leaves the nozzle as fast as the forces pull it out. A bead is
/// born as an embryo between the nozzle and bead 1, which is led until it is released (model 4).
class EmbryoInflow final : public InflowRule {
public:
  struct Rule {
    double link_length = 0;                    ///< l_step [m]
    LinkContent born;                          ///< what a new bead carries
    std::optional<Varicosity> varicosity = {}; ///< none: all beads alike
    ReleaseVelocity release = ReleaseVelocity::half;
  };
  EmbryoInflow(const Nozzle& nozzle, const Rule& rule)
      : InflowRule(nozzle)
      , rule_(rule)
      , embryo_{.link_length = rule.link_length} {}

  [[nodiscard]] const Rule& rule() const { return rule_; }
  [[nodiscard]] const Embryo& embryo() const { return embryo_; }
  [[nodiscard]] JetState start(std::shared_ptr<const BeadTable> table) const override;
  void prescribe(double t, bool has_led_bead, JetColumns<double> y) const override;
  [[nodiscard]] bool changes_content(bool has_led_bead) const override {
    return has_led_bead;
  }
  [[nodiscard]] LinkContent acting(const LinkContent& full, double since, double t,
                                   ConstVec3View r) const override;
  [[nodiscard]] LinkContent content_rate(const LinkContent& full,
                                         JetColumns<const double> y) const override;
  [[nodiscard]] Vec3 led_velocity(JetColumns<const double> y) const override;
  /// Release, then insertion: the order in which they are applied at one instant.
  [[nodiscard]] std::vector<std::unique_ptr<Event>> events() const override;

private:
  Rule rule_;
  Embryo embryo_;
};

/// An embryo is created between nozzle and bead 1 when |r_1 - r_0| reaches 1.5 l_step (model 4.1).
/// Nothing jumps: its charge grows from zero, and declared columns begin with their value at birth
/// (no stress).
class Insertion final : public Event {
public:
  /// `inflow` outlives the event.
  explicit Insertion(const EmbryoInflow& inflow)
      : inflow_(inflow) {}
  [[nodiscard]] std::string_view name() const override { return "insertion"; }
  [[nodiscard]] Channel channel() const override;
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }

private:
  [[nodiscard]] double excess(const DenseStep& step,
                              double theta) const; // [m], >= 0: happens

  const EmbryoInflow& inflow_;
};

/// The embryo becomes a free bead when |r_2 - r_0| reaches 2 l_step, with its full charge. Bead 2
/// keeps its stress and volume while its link shrinks from 2 l_step to l_step (model 4.2).
class Release final : public Event {
public:
  /// `inflow` outlives the event.
  explicit Release(const EmbryoInflow& inflow)
      : inflow_(inflow) {}
  [[nodiscard]] std::string_view name() const override { return "release"; }
  [[nodiscard]] Channel channel() const override;
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }

private:
  [[nodiscard]] double excess(const DenseStep& step, double theta) const;

  const EmbryoInflow& inflow_;
};

} // namespace ehdjet
