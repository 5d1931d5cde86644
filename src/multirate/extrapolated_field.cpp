#include "ehdjet/multirate/extrapolated_field.hpp"

#include "ehdjet/core/error.hpp"

#include <utility>

namespace ehdjet {
namespace {

/// Two times that are closer than this say little about the slope [s].
constexpr double too_close = 4e-6;

} // namespace

void ExtrapolatedField::add_force(const Stage& stage, Vec3View force) {
  if (known_ == 0) return;
  const BeadRange targets = stage.targets.within(beads_);
  const Known &old = past_[0], &last = past_[known_ - 1];
  const double ahead = known_ == 2 ? (stage.time - last.time) / (last.time - old.time) : 0;
  const double* q = stage.charge.data();
  double* out[]{force.x.data(), force.y.data(), force.z.data()};
  for (std::size_t c = 0; c < 3; ++c) {
    const double *a = old.field.data() + c * beads_, *b = last.field.data() + c * beads_;
    double* f = out[c];
    for (std::size_t k = targets.begin; k < targets.end; ++k)
      f[k] += q[k] * (b[k] + ahead * (b[k] - a[k]));
  }
}

void ExtrapolatedField::learn(double t, std::span<const double> field, std::size_t beads) {
  EHDJET_EXPECTS(field.size() == 3 * beads && (known_ == 0 || beads >= beads_));
  const std::size_t born = known_ == 0 ? 0 : beads - beads_;
  if (born > 0)
    for (std::size_t i = 0; i < known_; ++i) {
      std::vector<double> grown(3 * beads);
      for (std::size_t c = 0; c < 3; ++c) {
        const double *now = field.data() + c * beads,
                     *was = past_[i].field.data() + c * beads_;
        double* out = grown.data() + c * beads;
        out[0] = was[0];
        for (std::size_t k = 1; k < beads_; ++k) out[k + born] = was[k];
        for (std::size_t k = 1; k <= born; ++k) out[k] = was[1] + (now[k] - now[born + 1]);
      }
      past_[i].field = std::move(grown);
    }
  beads_ = beads;
  // The value before is dropped if it is too close, unless it is the last one itself.
  const bool far_enough = known_ > 0 && t - past_[known_ - 1].time >= too_close;
  if (known_ == 2 && far_enough) std::swap(past_[0], past_[1]);
  if (known_ == 0 || (known_ == 1 && far_enough)) ++known_;
  Known& now = past_[known_ - 1];
  now.time = t, now.field.assign(field.begin(), field.end());
}

void ExtrapolatedField::add_to_past(std::span<const double> field, std::size_t beads) {
  if (known_ == 0) return;
  EHDJET_EXPECTS(field.size() == 3 * beads && beads <= beads_);
  for (std::size_t i = 0; i < known_; ++i) {
    std::vector<double> changed(field.begin(), field.end());
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < beads; ++k)
        changed[c * beads + k] += past_[i].field[c * beads_ + k];
    past_[i].field = std::move(changed);
  }
  beads_ = beads;
}

void ExtrapolatedField::archive_past(const Archive& a, std::size_t beads) {
  a("beads", beads_), a("known", known_);
  a("old_time", past_[0].time), a("old_field", past_[0].field);
  a("last_time", past_[1].time), a("last_field", past_[1].field);
  bool fits = known_ <= past_.size() && (known_ == 0 || beads_ == beads);
  for (std::size_t i = 0; fits && i < known_; ++i)
    fits = past_[i].field.size() == 3 * beads;
  a.require("known", fits, "does not agree with the lists");
}

} // namespace ehdjet
