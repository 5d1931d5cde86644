#include "ehdjet/jet/mat.hpp"

#include <cmath>
#include <utility>

namespace ehdjet {
namespace {

/// What is left of the charges at time t.
void decay_to(double t, const std::optional<double>& decay_time, MatCharges& charges) {
  if (decay_time)
    for (double& q : charges.charge) q *= charges.remaining(t, decay_time);
  charges.time = t;
}

void append(const MatCharges& from, MatCharges& to) {
  const auto add = [](const std::vector<double>& more, std::vector<double>& all) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(from.x, to.x), add(from.y, to.y), add(from.z, to.z), add(from.charge, to.charge);
}

void archive(const Archive& a, MatCharges& charges) {
  std::optional<double> time;
  if (charges.size() > 0) time = charges.time;
  a("x", charges.x), a("y", charges.y), a("z", charges.z), a("charge", charges.charge);
  a("time", time);
  if (!a.is_reading()) return;
  charges.time = time.value_or(0);
  a.require("x", all_finite(charges.x), "is not finite");
  a.require("y", all_finite(charges.y), "is not finite");
  a.require("z", all_finite(charges.z), "is not finite");
  a.require("charge", all_finite(charges.charge), "is not finite");
  a.require("time", std::isfinite(charges.time), "is not finite");
  const std::size_t n = charges.size();
  a.require("charge",
            charges.x.size() == n && charges.y.size() == n && charges.z.size() == n,
            "has another length than the places");
  a.require("time", time.has_value() == (n > 0), "does not agree with charge");
}

} // namespace

double MatCharges::remaining(double t, const std::optional<double>& decay_time) const {
  return decay_time ? std::exp(-(t - time) / *decay_time) : 1.0;
}

std::shared_ptr<const Mat> with_charge(const std::shared_ptr<const Mat>& mat,
                                       const Vec3& place, double charge, double t,
                                       const std::optional<double>& decay_time) {
  auto next = mat ? std::make_shared<Mat>(*mat) : std::make_shared<Mat>();
  MatCharges& recent = next->recent;
  decay_to(t, decay_time, recent);
  recent.x.push_back(place.x()), recent.y.push_back(place.y());
  recent.z.push_back(place.z()), recent.charge.push_back(charge);
  if (recent.size() < Mat::block) return next;
  auto settled = next->settled ? std::make_shared<MatCharges>(*next->settled)
                               : std::make_shared<MatCharges>();
  decay_to(t, decay_time, *settled);
  append(recent, *settled);
  next->settled = std::move(settled), recent = {};
  return next;
}

void archive(const Archive& a, std::shared_ptr<const Mat>& mat) {
  // The lists are there without a mat, too: all checkpoints of a run have the same ones.
  Mat copy = mat && !a.is_reading() ? *mat : Mat{};
  MatCharges settled = copy.settled ? *copy.settled : MatCharges{};
  archive(a, copy.recent);
  const Archive of_settled = a.part("settled");
  // Checkpoints from before charges settled have them all in one part.
  if (!a.is_reading() || !of_settled.names().empty()) archive(of_settled, settled);
  if (!a.is_reading()) return;
  if (settled.size() > 0) copy.settled = std::make_shared<MatCharges>(std::move(settled));
  mat = copy.size() > 0 ? std::make_shared<Mat>(std::move(copy)) : nullptr;
}

} // namespace ehdjet
