#include "ehdjet/multirate/predictor.hpp"

#include "ehdjet/core/parallel.hpp"

namespace ehdjet {

void Predictor::start(const JetState& jet, std::span<const double> rate,
                      std::span<const double> jerk) {
  start_ = jet.time, beads_ = jet.beads();
  y_ = jet.y, rate_ = rate, jerk_ = jerk;
}

double Predictor::value(std::size_t column, std::size_t bead, double s) const {
  const std::size_t i = column * beads_ + bead;
  if (column >= 3) return y_[i] + s * (rate_[i] + s / 2 * jerk_[i]);
  const std::size_t v = i + 3 * beads_;
  return y_[i] + s * (rate_[i] + s / 2 * (rate_[v] + s / 3 * jerk_[v]));
}

void Predictor::prescribe(double t, JetColumns<double> y) const {
  const std::size_t shift = y.beads - count_;
  for (std::size_t c = 0; c < y.count(); ++c)
    for (std::size_t i = 0; i < count_; ++i)
      y.column(c)[shift + i] = value(c, first_ + i, t - start_);
}

void Predictor::places(double t, std::size_t first, Vec3View out) const {
  const double s = t - start_;
  double* columns[]{out.x.data(), out.y.data(), out.z.data()};
  for (std::size_t c = 0; c < 3; ++c) {
    const double *y = y_.data() + c * beads_ + first,
                 *v = rate_.data() + c * beads_ + first,
                 *a = rate_.data() + (c + 3) * beads_ + first,
                 *j = jerk_.data() + (c + 3) * beads_ + first;
    double* place = columns[c];
    for_parts(0, beads_ - first, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
      for (std::size_t i = begin; i < end; ++i)
        place[i] = y[i] + s * (v[i] + s / 2 * (a[i] + s / 3 * j[i]));
    });
  }
}

} // namespace ehdjet
