#pragma once

#include "ehdjet/jet/exchange.hpp"
#include "ehdjet/jet/inflow.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// Beads of a given chain that are held in place.
struct HeldEnds {
  bool first = false, last = false;
};

/// Knows how beads move that somebody else integrates: those of another part of the chain.
class Guide {
public:
  virtual ~Guide() = default;
  /// Puts the led beads, with the columns of their links, where they are at time t.
  virtual void prescribe(double t, JetColumns<double> y) const = 0;
};

/// A part of a chain that moves freely while the beads above or below it are led.
struct LedParts {
  std::size_t head = 0; ///< how many beads are led at the nozzle's end
  std::size_t tail = 0; ///< and at the other end
  const Guide* guide = nullptr;
  /// Beads that have passed the collector fly on under the forces that they would feel with their own
  /// charge. That keeps their motion smooth in steps that many beads pass in. Otherwise they fly on
  /// like the bead before them.
  bool passed_fly_on = false;
};

/// What keeps the beads of a scene from moving freely, besides the collector.
struct Constraints {
  const Inflow* inflow = nullptr; ///< null: bead 0 is an ordinary bead
  HeldEnds ends = {};
  /// Landed beads rest in the place of their image charges and act on no other bead (model 5).
  bool grounded_collector = false;
  /// Landed beads keep their charges when they leave the chain (model 5.2).
  bool insulating_collector = false;
  /// Of the collector, and so of landed beads (model 5.1) [m/s].
  Vec3 plate_velocity = Vec3::Zero();
  LedParts led = {};
};

/// A chain as force terms see it: which beads move freely, what they carry as they act, and a
/// `Stage` for any of its states. The equations of motion have one, a budget has its own.
class ActingChain {
public:
  void constrain(const Constraints& constraints) { constraints_ = constraints; }
  [[nodiscard]] const Constraints& constraints() const { return constraints_; }

  /// Takes over a chain; its state may be another one afterwards. With an `absorbing_plane` [m]
  /// beads beyond it count as absorbed (model 5).
  void bind(const JetState& jet, std::optional<double> absorbing_plane = {});

  /// The stage of state y at time t, valid until the next call. Prescribed beads stand in their
  /// places in y. `targets` and `sources`: see Stage.
  const Stage& at(double t, std::span<const double> y, BeadRange targets = {},
                  BeadRange sources = {});
  [[nodiscard]] const Stage& stage() const { return stage_; }

  [[nodiscard]] std::size_t beads() const { return mass_.size(); }
  [[nodiscard]] bool has_led_bead() const { return has_led_bead_; }
  [[nodiscard]] bool changes_content() const { return changes_content_; }
  [[nodiscard]] std::span<const double> mass() const { return mass_; }
  [[nodiscard]] std::span<const double> inverse_mass() const { return inverse_mass_; }
  /// Beads that do not move freely, and those of them whose link keeps its columns.
  [[nodiscard]] std::span<const std::size_t> held() const { return held_; }
  [[nodiscard]] std::span<const std::size_t> frozen() const { return frozen_; }
  [[nodiscard]] Support support(std::size_t bead) const;
  [[nodiscard]] const LinkContent& full_content() const { return full_; }

  /// Beads that the last stage has absorbed, from the end of the chain on: the first of them in the
  /// chain is the last entry. Empty if none has passed the plane since the step began.
  [[nodiscard]] std::span<const std::size_t> absorbed() const { return absorbed_; }
  [[nodiscard]] const std::optional<double>& absorbing_plane() const {
    return absorbing_plane_;
  }
  /// The first bead of the part of the chain, up to its end, that the last stage has absorbed; the
  /// number of beads if there is none.
  [[nodiscard]] std::size_t flying_on() const {
    return flying_on_ > 0 ? absorbed_[flying_on_ - 1] : beads();
  }
  /// The stage of that part alone. Its beads have their own charges in it and feel those of the other
  /// sources of the last stage. To be called after all that needs the last stage.
  const Stage& at_flying_on();

private:
  void find_held(const JetState& jet);
  void absorb(std::span<const double> y);
  void dry(JetColumns<const double> y);

  Constraints constraints_;
  Stage stage_;
  std::vector<double> mass_, charge_, volume_, inverse_mass_; // as they act
  std::optional<BeadTable::DryingColumn> drying_;
  std::vector<double> wet_mass_, wet_volume_; // used only with drying
  std::vector<double> link_charge_;           // used only with a grounded collector
  std::vector<std::vector<double>> declared_; // further carried columns
  std::vector<std::uint8_t> moves_;
  std::vector<LandedBead> landed_;
  std::shared_ptr<const Mat> mat_;
  std::vector<std::size_t> held_, frozen_;
  bool has_led_bead_ = false;
  LinkContent full_;     // of bead 1, while an inflow changes how it acts
  double fed_since_ = 0; // [s]
  std::optional<Feed> feed_;
  bool changes_content_ = false;
  std::optional<double> absorbing_plane_; // [m]
  std::vector<std::size_t> absorbed_;
  std::vector<double> charge_before_; // of the absorbed beads
  std::size_t flying_on_ = 0;         // how many of them are the end of the chain
  std::vector<double> state_;         // with absorbed beads where they crossed the plane
};

} // namespace ehdjet
