#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <string>
#include <vector>

namespace ehdjet {

/// What a scene means before it is run: every key with its unit, the dimensionless groups, the
/// stability limits of explicit steps, which physical limits the jet exceeds, what will be simulated,
/// and what it costs. Only the cost is an estimate; all else follows from the scene by the formulas of
/// dimensionless.hpp, stability.hpp and physics_report.cpp.
std::string scene_report(const Scene& scene);

/// What a run should say before it starts: what does not go together with a near field, a fixed step that is
/// too long, intervals that are too short. The report has them, too.
[[nodiscard]] std::vector<std::string> run_warnings(const Scene& scene);

} // namespace ehdjet
