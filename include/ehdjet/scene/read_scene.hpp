#pragma once

#include "ehdjet/scene/config.hpp"

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// A key that replaces or removes one of a scene file.
struct Override {
  /// "table.key=value", value in TOML syntax; a bare word is taken as a string, an empty value removes
  /// the key ("integrator.rtol=") or the whole table ("gravity=").
  std::string assignment;
  std::string origin; ///< where it stands, for messages: "--set gravity=", "plan.toml:7"
};

/// In the order in which they are applied.
class Overrides {
public:
  Overrides() = default;
  Overrides(std::vector<Override> all)
      : all_(std::move(all)) {}
  /// Assignments as they are given to --set.
  Overrides(const std::vector<std::string>& assignments) {
    for (const std::string& a : assignments) all_.push_back({a, "--set " + a});
  }
  Overrides(std::initializer_list<std::string> assignments)
      : Overrides(std::vector<std::string>(assignments)) {}

  [[nodiscard]] auto begin() const { return all_.begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }

private:
  std::vector<Override> all_;
};

/// Reads and validates a scene file (TOML).
///
/// errors : InputError that names file, line, key, value, unit and allowed range; for an unknown
///          key the nearest known one; for contradicting keys both of them
Scene read_scene(const std::filesystem::path& file, const Overrides& overrides = {});

/// The same from text; `name` stands for the file in messages, `folder` resolves relative paths.
Scene read_scene_text(const std::string& text, const std::string& name,
                      const std::filesystem::path& folder, const Overrides& overrides = {});

/// The scene with every default filled in, as TOML that reads back to the same configuration,
/// each key followed by its unit and meaning as a comment.
std::string resolved_toml(const SceneConfig& config);

/// Every "table.key" of a scene, given as `resolved_toml`, with its value in TOML syntax.
std::map<std::string, std::string> resolved_values(const std::string& resolved);

/// Where a scene differs from another one, given as `resolved_toml`, in more than run.end_time and
/// [output]: the key and both its values. None if it does not.
std::optional<std::string> difference_from(const std::string& resolved,
                                           const SceneConfig& config);
/// The same for what a run file holds: all differences in keys that change what is written, [output]
/// included. Empty if a run of `config` can go on in the file of the other one.
std::vector<std::string> differences_in_file(const std::string& resolved,
                                             const SceneConfig& config);

/// The configuration that a `resolved_toml` says, perhaps one of another version. Other files that it
/// names are not read. errors : InputError if it is not TOML, or a value is not what its key allows
SceneConfig config_of(const std::string& resolved);

/// Unit of a key, "table.key"; empty for pure numbers, texts and unknown keys.
std::string key_unit(std::string_view path);

/// Reference page of every table and key: unit, allowed range, default, meaning (Markdown).
std::string key_reference();

} // namespace ehdjet
