#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "support/scenes.hpp"

/// States of case I from an independent program, converged in time.
namespace ehdjet::test {

/// The larger of two, or a number that is none.
inline double larger(double a, double b) {
  return b <= a ? a : b;
}

/// Worst deviation of a jet from the reference state of the same time.
struct Deviation {
  double position = 0, velocity = 0, stress = 0; // [m], [m/s], [Pa]
};

inline Deviation deviation(const JetState& jet, const std::string& file) {
  const Table reference("case_one/" + file);
  EXPECT_EQ(jet.beads(), reference.rows());
  Deviation d;
  if (jet.beads() != reference.rows()) return {std::nan(""), std::nan(""), std::nan("")};
  const auto c = jet.columns();
  for (std::size_t k = 0; k < reference.rows(); ++k) {
    const auto at = [&](const char* column) { return reference.at(k, column); };
    EXPECT_EQ(jet.is_landed(k), at("landed") == 1) << k;
    EXPECT_EQ(jet.has_embryo && k == 1, at("embryo") == 1) << k;
    EXPECT_NEAR(jet.mass[k] / (at("mass_g") * gram), 1, 1e-14) << k;
    EXPECT_NEAR(jet.charge[k] / (at("charge_statC") * statC), 1, 1e-14) << k;
    EXPECT_NEAR(jet.volume[k] / (at("volume_cm3") * cm3), 1, 1e-14) << k;
    d.position =
        larger(d.position,
               (c.position()[k] - cm * Vec3(at("x_cm"), at("y_cm"), at("z_cm"))).norm());
    d.velocity = larger(
        d.velocity,
        (c.velocity()[k] - cm * Vec3(at("vx_cm_s"), at("vy_cm_s"), at("vz_cm_s"))).norm());
    d.stress = larger(d.stress, std::abs(stress_of(c)[k] - dyn_cm2 * at("stress_dyn_cm2")));
  }
  return d;
}

inline std::string state_at(double ms) {
  char name[40];
  std::snprintf(name, sizeof name, "state_t%05.0fus.csv", 1e3 * ms);
  return name;
}

} // namespace ehdjet::test
