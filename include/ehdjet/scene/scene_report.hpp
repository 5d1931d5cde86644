#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <string>

namespace ehdjet {

/// What a scene means before it is run: every key with its unit, the dimensionless groups, the
/// stability limits of explicit steps, and what will be simulated. Nothing in it is an estimate
/// of the jet's motion; it follows from the scene by the formulas of dimensionless.hpp and
/// stability.hpp.
std::string scene_report(const Scene& scene);

} // namespace ehdjet
