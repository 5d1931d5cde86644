#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ehdjet {

/// A run of a sweep.
struct SweepRun {
  std::string id;                  ///< name of its files without extension
  std::string scene;               ///< text of its scene file, with every key
  std::vector<std::string> values; ///< of `Sweep::keys`, in TOML syntax
};

/// Scenes that differ in a few keys.
struct Sweep {
  std::string plan;              ///< name of the plan file
  std::vector<std::string> keys; ///< "table.key" that the plan varies, in its order
  std::vector<SweepRun> runs;    ///< the last key of the plan varies fastest

  /// CSV: id, scene file, run file, value of each key; one row per run.
  [[nodiscard]] std::string index() const;
};

/// Reads a plan (TOML, docs/sweeps.md) and expands it. Every scene is read, checked and built; paths
/// in it are relative to `folder`, where its file will be.
///
/// errors : InputError with file, line, key, value, unit and allowed range, of the plan or of its scene
Sweep read_sweep(const std::filesystem::path& plan, const std::filesystem::path& folder);

/// What `write_sweep` has done, in numbers of scene files.
struct SweepFiles {
  std::size_t written = 0, unchanged = 0;
  std::vector<std::string> dropped; ///< files that a former plan made and this one does not
};

/// Writes the scene files and, last, `index.csv` into a folder. Files that are there already, with the
/// same text, are not touched.
///
/// errors : InputError if a file with another text exists and `overwrite` is false; nothing has been
///          written then. RunError if a file cannot be written
SweepFiles write_sweep(const Sweep& sweep, const std::filesystem::path& folder,
                       bool overwrite);

} // namespace ehdjet
