#pragma once

#include "ehdjet/jetspin/import_input.hpp"
#include "ehdjet/scene/read_scene.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include "support/folder.hpp"

namespace ehdjet::test {

/// The text of an input file with the values of one of JETSPIN's six examples.
inline std::string example_text(int number) {
  std::ifstream in(EHDJET_TEST_DATA "/jetspin/example" + std::to_string(number) + ".dat");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// An imported scene as `ehdjet run` would read it, with the file of its beads.
inline Scene read_imported(const ImportedScene& imported) {
  const Folder folder;
  if (!imported.beads.empty()) std::ofstream(folder / "beads.csv") << imported.beads;
  check_imported(imported, "input.dat", folder.path());
  return read_scene_text(imported.text, "scene.toml", folder.path());
}

/// Example 4 has a random force, which is left out.
inline Scene example(int number) {
  return read_imported(
      import_jetspin(example_text(number), "input.dat", {.without_noise = true}));
}

} // namespace ehdjet::test
