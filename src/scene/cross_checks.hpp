#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include "scene_text.hpp"

namespace ehdjet {

/// Checks what concerns more than one key and fills in the defaults that depend on others.
/// errors : InputError that names both keys and their numbers
void settle(SceneConfig& config, const SceneText& text);

/// Checks that the beads of a chain scene fit the rest of the scene.
void check_chain_fits(const Scene& scene, const SceneText& text);

/// Refuses an explicit method for a fluid that would hold its adaptive steps at their stability
/// limit for a very long time.
void check_stability(const Scene& scene, const SceneText& text);

} // namespace ehdjet
