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
  if (a.is_reading() ? a.names().empty() : !mat) {
    mat.reset();
    return;
  }
  auto copy = a.is_reading() ? std::make_shared<Mat>() : std::make_shared<Mat>(*mat);
  a("x", copy->x), a("y", copy->y), a("z", copy->z), a("charge", copy->charge);
  a("time", copy->time);
  const std::size_t n = copy->size();
  if (copy->x.size() != n || copy->y.size() != n || copy->z.size() != n)
    throw InputError("the checkpoint is damaged: the columns of the mat have different "
                     "lengths");
  mat = std::move(copy);
}

} // namespace ehdjet
