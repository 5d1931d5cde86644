#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ehdjet {

/// Keys that change together.
struct SweepFactor {
  struct Level {
    std::string name;                ///< part of the names of files
    std::vector<Override> overrides; ///< one per key
  };
  std::vector<std::string> keys; ///< "table.key"
  std::vector<Level> levels;
};

/// A plan as it is in its file.
struct SweepPlan {
  std::filesystem::path scene;      ///< relative to the present folder, or absolute
  std::string name;                 ///< of all runs
  std::size_t repeats = 1;          ///< runs of each scene
  std::vector<Override> settings;   ///< of all runs
  std::vector<SweepFactor> factors; ///< in the order of the file
};

/// errors : InputError with file, line, key and what is allowed. Whether a scene may have a key with
///          that value is not looked at
SweepPlan read_plan(const std::filesystem::path& file);

} // namespace ehdjet
