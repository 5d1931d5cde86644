#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Scenes by name.
namespace ehdjet::cli {

/// The folders in which scenes are looked for by name, the first one first: those of the environment
/// variable EHDJET_SCENES, separated by colons, and share/ehdjet/scenes beside the folder of the program.
[[nodiscard]] std::vector<std::filesystem::path> scene_folders();

/// The file that the user means: a path, or the name of a scene, with or without .toml, in this folder or in
/// one of `scene_folders`.
/// errors : InputError with the nearest name if there is none
[[nodiscard]] std::filesystem::path find_scene(const std::string& given);

/// Where a scene comes from, for the run file: a file, or the scene file of a run file.
[[nodiscard]] std::string origin_of(const std::filesystem::path& file);

/// Whether a file is an HDF5 file, as run files are.
[[nodiscard]] bool is_run_file(const std::filesystem::path& file);

/// Reads a scene file, or the scene with which a run file was made.
[[nodiscard]] Scene read_scene_or_run(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides);

} // namespace ehdjet::cli
