#pragma once

#include "ehdjet/scene/config.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ehdjet {

/// A scene that has been read and found valid.
struct Scene {
  SceneConfig config;
  ChainBeads chain;               ///< the beads of a chain scene; empty for a nozzle scene
  std::optional<CostModel> costs; ///< of the calibration that the scene names
  AirProfile air_profile;         ///< of the file that the scene names
  std::string given;              ///< the text as read, byte for byte
};

/// Reads and validates a scene file (TOML). `overrides` are "table.key=value" as given to --set,
/// value in TOML syntax; a bare word is taken as a string, an empty value removes the key
/// ("integrator.rtol=") or the whole table ("gravity=").
///
/// errors : InputError that names file, line, key, value, unit and allowed range; for an unknown
///          key the nearest known one; for contradicting keys both of them
Scene read_scene(const std::filesystem::path& file,
                 const std::vector<std::string>& overrides = {});

/// The same from text; `name` stands for the file in messages, `folder` resolves relative paths.
Scene read_scene_text(const std::string& text, const std::string& name,
                      const std::filesystem::path& folder,
                      const std::vector<std::string>& overrides = {});

/// The scene with every default filled in, as TOML that reads back to the same configuration,
/// each key followed by its unit and meaning as a comment.
std::string resolved_toml(const SceneConfig& config);

/// Where a scene differs from another one, given as `resolved_toml`, in more than run.end_time and
/// [output]: the key and both its values. None if it does not.
std::optional<std::string> difference_from(const std::string& resolved,
                                           const SceneConfig& config);

/// Reference page of every table and key: unit, allowed range, default, meaning (Markdown).
std::string key_reference();

} // namespace ehdjet
