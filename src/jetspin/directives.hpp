#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The directives of a JETSPIN input file.
namespace ehdjet {

/// What a record gives besides its keywords.
enum class Given {
  nothing,
  number,
  integer,
  triple,
  yes,    ///< the value is 1
  no,     ///< the value is 0
  choice, ///< the value is the place of the last keyword among its choices
};

struct Directive {
  /// A record is this directive if a word of it begins with each of the keywords.
  std::vector<std::string_view> keywords;
  Given given = Given::number;
  /// What to say if it is left out. Directives without this text are imported, or stand for
  /// something that must first be on.
  std::string_view left_out = {};
  /// Why a file with it cannot be imported.
  std::string_view refused = {};
  double value = 0; ///< of a choice

  /// The keywords, without yes, no or a choice: "nozzle cross", "gravity".
  [[nodiscard]] std::string name() const;
};

/// All of them, in the order in which they are tried: the first that fits a record is meant.
const std::vector<Directive>& jetspin_directives();

/// A record that was read.
struct Setting {
  const Directive* directive = nullptr;
  std::size_t line = 0;
  std::vector<double> values = {};
};

/// The last record of each directive, by name, and remarks on how records were understood.
struct Settings {
  std::map<std::string, Setting, std::less<>> by_name;
  std::vector<std::string> remarks;
};

/// Reads the file up to its record `finish`. `name` stands for it in messages.
///
/// errors : InputError with file, line and the nearest directive if a record is none of those; also for a
///          number that is missing or malformed, for what cannot be imported, and for a file without `finish`
Settings read_settings(std::string_view text, const std::string& name);

} // namespace ehdjet
