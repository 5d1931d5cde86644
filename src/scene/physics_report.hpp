#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <string>
#include <vector>

namespace ehdjet {

/// What a physicist should know about a jet before it runs: field at its surface, Rayleigh limit, end of
/// conduction, links that are too short for their near field. Warnings, not refusals.
[[nodiscard]] std::string physics_text(const Scene& scene);
/// What in a scene does not go together with its near field.
[[nodiscard]] std::vector<std::string> near_field_warnings(const SceneConfig& config);
/// Beads, evaluations, wall time and file size of a pumped jet; the flow of others is not known before.
[[nodiscard]] std::string cost_text(const Scene& scene);

} // namespace ehdjet
