#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <type_traits>

namespace ehdjet {

using Vec3 = Eigen::Vector3d;

/// Non-owning view of n vectors stored as three arrays (structure of arrays), so that
/// loops over beads vectorise. T is `double` (writable) or `const double` (read-only).
template <class T>
struct Vec3Columns {
  std::span<T> x, y, z;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }

  void set(std::size_t i, const Vec3& v) const requires(!std::is_const_v<T>) {
    x[i] = v.x(), y[i] = v.y(), z[i] = v.z();
  }
  void add(std::size_t i, const Vec3& v) const requires(!std::is_const_v<T>) {
    x[i] += v.x(), y[i] += v.y(), z[i] += v.z();
  }
  operator Vec3Columns<const T>() const {
    return {x, y, z};
  } // a writable view is also a read-only one
};

using Vec3View = Vec3Columns<double>;
using ConstVec3View = Vec3Columns<const double>;

} // namespace ehdjet
