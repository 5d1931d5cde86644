#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <string>

namespace ehdjet {

/// What a physicist should know about a jet before it runs: surface field, Rayleigh limit, links that
/// are too short or lack a near field, flow of a pump; and what a run costs. Warnings, not refusals.
[[nodiscard]] std::string physics_text(const Scene& scene);
[[nodiscard]] std::string cost_text(const Scene& scene);

} // namespace ehdjet
