#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Input files of JETSPIN (Lauricella et al., Comput. Phys. Commun. 197 (2015) 227) as scenes. What each
/// directive becomes is in docs/jetspin.md.
namespace ehdjet {

struct JetspinImportOptions {
  /// Leave random forces out. Otherwise an input with one is refused: ehdjet has none.
  bool without_noise = false;
  /// JETSPIN's method and time step instead of steps with error control.
  bool fixed_steps = false;
  /// Name that the scene gives to the file of its beads, if it needs one.
  std::string beads_file = "beads.csv";
};

/// A scene that does what a JETSPIN input says.
struct ImportedScene {
  std::string
      text; ///< TOML, in SI units; every key with the line and directive that it comes from
  std::string beads; ///< CSV, if the jet is a given chain (`inserting no`); otherwise empty
  /// What was left out or works in another way. The scene has them as comments, too.
  std::vector<std::string> remarks;
  /// Where each key comes from, for messages.
  std::vector<std::pair<std::string, std::string>> origins;
};

/// Reads the text of an input file; `name` stands for it in messages.
///
/// errors : InputError with file and line: a record is no directive, or cannot be imported; a directive is missing
ImportedScene import_jetspin(std::string_view text, const std::string& name,
                             const JetspinImportOptions& options = {});

/// Refuses a scene that `ehdjet check` would refuse. The file of its beads must be in `folder`.
///
/// errors : InputError with what is wrong in the scene, and the directive that it comes from
void check_imported(const ImportedScene& scene, const std::string& name,
                    const std::filesystem::path& folder);

} // namespace ehdjet
