#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/complaint.hpp"

namespace ehdjet {

/// A complete nozzle scene; the tests break one line of it at a time.
inline const std::string good_scene = R"(title = "good"
[run]
end_time = 0.01
[nozzle]
radius = 5e-5
link_length = 2e-4
velocity = 3e-3
density = 840
charge_density = 14.7
[collector]
distance = 0.16
[field]
potential = 9000
[gravity]
acceleration = 9.80665
[coulomb]
[viscoelasticity]
elastic_modulus = 5e3
viscosity = 2
[surface_tension]
coefficient = 0.021
[integrator]
rtol = 1e-5
[output]
observables = 1e-4
)";

/// The good scene with one piece of its text replaced.
inline std::string good_scene_but(const std::string& piece, const std::string& by) {
  std::string text = good_scene;
  const auto at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), by);
}

inline Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_scene_text(text, "s.toml", ".", overrides);
}

inline std::string complaint_about(const std::string& text,
                                   const std::vector<std::string>& overrides = {}) {
  return complaint([&] { read(text, overrides); });
}

} // namespace ehdjet
