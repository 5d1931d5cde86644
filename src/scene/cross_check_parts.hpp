#pragma once

#include "ehdjet/scene/dimensionless.hpp"
#include "ehdjet/scene/schema.hpp"

#include "scene_text.hpp"

/// What `settle` consists of, by subject. All refuse with an InputError that names the keys and their
/// values.
namespace ehdjet {

// check_jet.cpp: where jets come from, what pulls at them, where they land.
void check_jet(const SceneConfig& c, const SceneText& text);
void check_field(const SceneConfig& c, const SceneText& text);
void check_waveform(const SceneConfig& c, const SceneText& text);
void check_collector(const SceneConfig& c, const SceneText& text);
void check_varicosity(const SceneConfig& c, const SceneText& text);
void check_array(const SceneConfig& c, const SceneText& text);

// check_fluid.cpp: the law of the stress, the air, and what evaporates into it.
void check_rheology(const SceneConfig& c, const SceneText& text);
void check_air(const SceneConfig& c, const SceneText& text);
void check_evaporation(const SceneConfig& c, const SceneText& text);

// check_steps.cpp: the integrator. The first one also fills in a tolerance that is not given.
void settle_step(IntegratorConfig& i, const SceneText& text);
void check_adaptive_keys(const IntegratorConfig& i, const SceneText& text);
void check_two_rates(const SceneConfig& c, const SceneText& text);

} // namespace ehdjet
