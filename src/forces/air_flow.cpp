#include "ehdjet/forces/air_flow.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace ehdjet {

AirFlow::AirFlow(double density, double kinematic_viscosity, const Vec3& velocity)
    : density_(density)
    , kinematic_viscosity_(kinematic_viscosity)
    , velocity_(velocity) {
  EHDJET_EXPECTS(density > 0 && kinematic_viscosity > 0);
}

AirFlow::AirFlow(double density, double kinematic_viscosity, AirProfile velocity)
    : density_(density)
    , kinematic_viscosity_(kinematic_viscosity)
    , profile_(std::move(velocity)) {
  EHDJET_EXPECTS(density > 0 && kinematic_viscosity > 0 && !profile_.x.empty());
  EHDJET_EXPECTS(profile_.x.size() == profile_.ux.size()
                 && profile_.x.size() == profile_.uy.size()
                 && profile_.x.size() == profile_.uz.size());
  EHDJET_EXPECTS(std::ranges::adjacent_find(profile_.x, std::greater_equal{})
                 == profile_.x.end());
}

Vec3 AirFlow::velocity(double x) const {
  const AirProfile& p = profile_;
  if (p.x.empty()) return velocity_;
  const auto at = [&](std::size_t i) { return Vec3(p.ux[i], p.uy[i], p.uz[i]); };
  const auto above = std::ranges::upper_bound(p.x, x);
  if (above == p.x.begin()) return at(0);
  if (above == p.x.end()) return at(p.x.size() - 1);
  const auto i = static_cast<std::size_t>(above - p.x.begin());
  const double share = (x - p.x[i - 1]) / (p.x[i] - p.x[i - 1]);
  return (1 - share) * at(i - 1) + share * at(i);
}

void AirFlow::relative_velocity(ConstVec3View r, ConstVec3View v, std::size_t begin,
                                Vec3View w) const {
  if (!profile_.x.empty()) {
    for (std::size_t i = 0; i < w.size(); ++i)
      w.set(i, v[begin + i] - velocity(r.x[begin + i]));
    return;
  }
  const auto subtract = [&](std::span<const double> from, double u, std::span<double> out) {
    const double* f = from.data() + begin;
    double* o = out.data();
#pragma omp simd
    for (std::size_t i = 0; i < out.size(); ++i) o[i] = f[i] - u;
  };
  subtract(v.x, velocity_.x(), w.x);
  subtract(v.y, velocity_.y(), w.y);
  subtract(v.z, velocity_.z(), w.z);
}

} // namespace ehdjet
