#include "ehdjet/multirate/projected_field.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>

namespace ehdjet {

std::array<double, ProjectedField::degrees>
ProjectedField::polynomials(double place) const {
  const double x = 2 * place - 1;
  return {1, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x};
}

void ProjectedField::begin(double t, double h, std::size_t first, std::size_t count) {
  start_ = t, length_ = h, first_ = first, beads_ = count;
  coefficient_.assign(3 * degrees * count, 0.0);
}

void ProjectedField::add(double place, double weight, std::span<const double> field) {
  EHDJET_EXPECTS(field.size() == 3 * beads_);
  const auto p = polynomials(place);
  const double* e = field.data();
  const std::size_t size = field.size();
  for (std::size_t d = 0; d < degrees; ++d) {
    const double w = static_cast<double>(2 * d + 1) * weight * p[d];
    double* c = coefficient_.data() + d * size;
    for_parts(0, size, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
      for (std::size_t i = begin; i < end; ++i) c[i] += w * e[i];
    });
  }
}

void ProjectedField::add_force(const Stage& stage, Vec3View force) {
  if (beads_ == 0) return;
  const auto p = polynomials((stage.time - start_) / length_);
  BeadRange targets = stage.targets.within(first_ + beads_);
  targets.begin = std::max(targets.begin, first_);
  const double* q = stage.charge.data();
  double* out[]{force.x.data(), force.y.data(), force.z.data()};
  for (std::size_t c = 0; c < 3; ++c) {
    const double *c0 = coefficient_.data() + c * beads_, *c1 = c0 + 3 * beads_,
                 *c2 = c1 + 3 * beads_, *c3 = c2 + 3 * beads_;
    double* f = out[c];
    const std::size_t first = first_;
    for_parts(targets.begin, targets.end, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t i = k - first;
        f[k] += q[k] * (p[0] * c0[i] + p[1] * c1[i] + p[2] * c2[i] + p[3] * c3[i]);
      }
    });
  }
}

void ProjectedField::add_acceleration(double t, double factor,
                                      std::span<const double> charge,
                                      std::span<const double> inverse_mass,
                                      Vec3View rate) const {
  const auto p = polynomials((t - start_) / length_);
  double* out[]{rate.x.data(), rate.y.data(), rate.z.data()};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < beads_; ++i) {
      double field = 0;
      for (std::size_t d = 0; d < degrees; ++d)
        field += p[d] * coefficient_[(3 * d + c) * beads_ + i];
      const std::size_t k = first_ + i;
      out[c][k] += factor * charge[k] * inverse_mass[k] * field;
    }
}

} // namespace ehdjet
