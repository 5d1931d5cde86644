#include "ehdjet/dynamics/acting_chain.hpp"

#include "ehdjet/core/parallel.hpp"

#include <algorithm>

namespace ehdjet {

void ActingChain::bind(const JetState& jet, std::optional<double> absorbing_plane) {
  mass_ = jet.mass, charge_ = jet.charge, volume_ = jet.volume, landed_ = jet.landed;
  declared_ = jet.declared;
  absorbing_plane_ = absorbing_plane, absorbed_.clear();
  has_led_bead_ = jet.has_embryo;
  drying_ = jet.table->drying();
  if (drying_) wet_mass_ = mass_, wet_volume_ = volume_;
  inverse_mass_.resize(mass_.size());
  std::ranges::transform(mass_, inverse_mass_.begin(), [](double m) { return 1 / m; });
  const Inflow* inflow = constraints_.inflow;
  changes_content_ = inflow != nullptr && inflow->changes_content(has_led_bead_);
  if (changes_content_)
    full_ = {.volume = volume_[1], .mass = mass_[1], .charge = charge_[1]};
  if (drying_) dry(jet.columns());
  fed_since_ = jet.fed_since;
  feed_ = inflow != nullptr ? inflow->feed() : std::nullopt;

  find_held(jet);

  stage_.link_charge = charge_;
  if (constraints_.grounded_collector) {
    link_charge_ = charge_, stage_.link_charge = link_charge_;
    for (const LandedBead& b : landed_) charge_[b.bead] = 0;
  }
  stage_.mass = mass_, stage_.charge = charge_, stage_.volume = volume_;
  stage_.feed = feed_ ? &*feed_ : nullptr;
  stage_.declared = declared_;
  stage_.field_is_off = jet.field_is_off;
  mat_ = jet.mat, stage_.mat = mat_.get();
  stage_.plate_velocity = constraints_.plate_velocity;
  stage_.first = jet.first(), stage_.landed = landed_, stage_.moves = moves_;
}

void ActingChain::find_held(const JetState& jet) {
  held_.clear();
  if (constraints_.inflow != nullptr || constraints_.ends.first) held_.push_back(0);
  if (has_led_bead_) held_.push_back(1);
  for (const LandedBead& b : landed_) held_.push_back(b.bead);
  const std::size_t n = mass_.size();
  const LedParts& led = constraints_.led;
  for (std::size_t k = has_led_bead_ ? 2 : 1; k < led.head; ++k) held_.push_back(k);
  for (std::size_t k = n - led.tail; k < n; ++k) held_.push_back(k);
  frozen_ = held_;
  if (constraints_.ends.last)
    held_.push_back(jet.links()); // its link goes on like any other
  moves_.assign(mass_.size(), 1);
  for (const std::size_t k : held_) moves_[k] = 0;
}

const Stage& ActingChain::at_flying_on() {
  const std::size_t begin = flying_on();
  stage_.absorbed = {};
  for (std::size_t i = 0; i < flying_on_; ++i) charge_[absorbed_[i]] = charge_before_[i];
  stage_.targets.begin = std::max(stage_.targets.begin, begin);
  stage_.sources.end = std::min(stage_.sources.end, begin);
  stage_.sources.begin = std::min(stage_.sources.begin, begin);
  stage_.invalidate();
  return stage_;
}

const Stage& ActingChain::at(double t, std::span<const double> y, BeadRange targets,
                             BeadRange sources) {
  for (std::size_t i = 0; i < absorbed_.size(); ++i)
    charge_[absorbed_[i]] = charge_before_[i];
  absorbed_.clear(), flying_on_ = 0;
  stage_.time = t, stage_.columns = {y, mass_.size()};
  stage_.targets = targets.within(mass_.size());
  stage_.sources = sources.within(mass_.size());
  stage_.invalidate();
  if (changes_content_) {
    const LinkContent now =
        constraints_.inflow->acting(full_, fed_since_, t, stage_.columns.position());
    (drying_ ? wet_volume_ : volume_)[1] = now.volume;
    (drying_ ? wet_mass_ : mass_)[1] = now.mass;
    if (!constraints_.grounded_collector || support(1) != Support::collector)
      charge_[1] = now.charge;
    if (!link_charge_.empty()) link_charge_[1] = now.charge;
    inverse_mass_[1] = 1 / now.mass;
  }
  if (drying_) dry(stage_.columns);
  if (absorbing_plane_) absorb(y);
  stage_.absorbed = absorbed_;
  return stage_;
}

// V = V_0 (1 - e),  m = m_0 (1 - e rho_s/rho)                              (model 2.2)
void ActingChain::dry(JetColumns<const double> y) {
  const double *lost = y.column(drying_->column).data(), *wet_mass = wet_mass_.data(),
               *wet_volume = wet_volume_.data(), share = drying_->mass;
  double *mass = mass_.data(), *volume = volume_.data(), *inverse = inverse_mass_.data();
  for_parts(0, mass_.size(), [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) {
      volume[k] = wet_volume[k] * (1 - lost[k]);
      mass[k] = wet_mass[k] * (1 - share * lost[k]);
      inverse[k] = 1 / mass[k];
    }
  });
}

// A bead that has passed the plane since the step began acts from where it crossed:
//
//     r - (v - U) (x - h)/v_x                                                   (model 5)
//
// where the plate, which moves at U, has taken it since then.
// To fly on with the velocity of the crossing is right to second order in the time since then,
// which is less than a step. On an insulating collector they keep their charges. Otherwise all beads at
// the end of the chain but the last one of those that have passed have left the chain and act on no other
// bead. On a grounded collector that one does not act either. Within a long step beads may pass that have
// others behind them which have not; they wait.
void ActingChain::absorb(std::span<const double> y) {
  const auto r = stage_.columns.position(), v = stage_.columns.velocity();
  const auto rests = [&](std::size_t k) { return support(k) == Support::collector; };
  bool any = false, at_end = true;
  for (std::size_t k = mass_.size(); k-- > stage_.first;) {
    if (!rests(k)) {
      if (!(r.x[k] > *absorbing_plane_)) {
        if (!constraints_.led.passed_fly_on) break;
        at_end = false;
        continue;
      }
      any = true;
    }
    absorbed_.push_back(k);
    if (at_end) flying_on_ = absorbed_.size();
  }
  if (!any) {
    absorbed_.clear(), flying_on_ = 0;
    return;
  }
  state_.resize(y.size());
  for_parts(0, y.size(), [&](std::size_t begin, std::size_t end) {
    std::copy(y.data() + begin, y.data() + end, state_.data() + begin);
  });
  const Vec3View place = JetColumns<double>{state_, mass_.size()}.position();
  charge_before_.clear();
  for (std::size_t i = 0; i < absorbed_.size(); ++i) {
    const std::size_t k = absorbed_[i];
    charge_before_.push_back(charge_[k]);
    const bool has_left = i + 1 < flying_on_ && !constraints_.insulating_collector;
    if (has_left || constraints_.grounded_collector) charge_[k] = 0;
    if (rests(k)) continue;
    const double late = v.x[k] > 0 ? (r.x[k] - *absorbing_plane_) / v.x[k] : 0.0;
    place.set(k, r[k] - late * (v[k] - constraints_.plate_velocity));
  }
  stage_.columns = {state_, mass_.size()};
}

Support ActingChain::support(std::size_t bead) const {
  if (moves_[bead] != 0) return Support::none;
  for (const LandedBead& b : landed_)
    if (b.bead == bead) return Support::collector;
  if (bead >= mass_.size() - constraints_.led.tail) return Support::clamp;
  if (constraints_.inflow == nullptr) return Support::clamp;
  return bead == 0 ? Support::inflow : bead == 1 ? Support::insertion : Support::clamp;
}

} // namespace ehdjet
