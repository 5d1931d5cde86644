#include "ehdjet/jet/mat.hpp"

#include <cmath>
#include <utility>

namespace ehdjet {

double Mat::remaining(double t, const std::optional<double>& decay_time) const {
  return decay_time ? std::exp(-(t - time) / *decay_time) : 1.0;
}

std::shared_ptr<const Mat> with_charge(const std::shared_ptr<const Mat>& mat,
                                       const Vec3& place, double charge, double t,
                                       const std::optional<double>& decay_time) {
  auto next = mat ? std::make_shared<Mat>(*mat) : std::make_shared<Mat>();
  if (decay_time)
    for (double& q : next->charge) q *= mat->remaining(t, decay_time);
  next->x.push_back(place.x()), next->y.push_back(place.y());
  next->z.push_back(place.z());
  next->charge.push_back(charge), next->time = t;
  return next;
}

void archive(const Archive& a, std::shared_ptr<const Mat>& mat) {
  // The lists are there without a mat, too: all checkpoints of a run have the same ones.
  auto copy =
      mat && !a.is_reading() ? std::make_shared<Mat>(*mat) : std::make_shared<Mat>();
  std::optional<double> time;
  if (mat) time = mat->time;
  a("x", copy->x), a("y", copy->y), a("z", copy->z), a("charge", copy->charge);
  a("time", time);
  if (!a.is_reading()) return;
  copy->time = time.value_or(0);
  a.require("x", all_finite(copy->x), "is not finite");
  a.require("y", all_finite(copy->y), "is not finite");
  a.require("z", all_finite(copy->z), "is not finite");
  a.require("charge", all_finite(copy->charge), "is not finite");
  a.require("time", std::isfinite(copy->time), "is not finite");
  const std::size_t n = copy->size();
  a.require("charge", copy->x.size() == n && copy->y.size() == n && copy->z.size() == n,
            "has another length than the places");
  a.require("time", time.has_value() == (n > 0), "does not agree with charge");
  mat.reset();
  if (n > 0) mat = std::move(copy);
}

} // namespace ehdjet
