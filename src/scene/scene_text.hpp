#pragma once

#include "ehdjet/scene/read_scene.hpp"

#include <map>
#include <string>
#include <string_view>
#include <toml++/toml.h>

namespace ehdjet {

/// A scene as parsed TOML with the overrides applied, which knows where every value
/// came from. Keys are addressed as "table.key".
class SceneText {
public:
  /// errors : InputError with file, line and column if the text or an override is not TOML
  SceneText(const std::string& text, const std::string& name, const Overrides& overrides);

  [[nodiscard]] const toml::table& root() const { return root_; }
  [[nodiscard]] const toml::node* find(std::string_view path) const; ///< null if not given
  /// "file:line" or the override; for a key that is not given, its table, then the file.
  [[nodiscard]] std::string where(std::string_view path) const;
  /// Throws InputError "where: message".
  [[noreturn]] void fail(std::string_view path, std::string_view message) const;

private:
  void override_with(const Override& override);

  std::string name_;
  toml::table root_;
  std::map<std::string, std::string, std::less<>>
      overridden_; // path -> origin of the override
};

/// A value as it stands in messages: 0.5, "text", true, [1, 2], or the name of another compound type.
[[nodiscard]] std::string value_text(const toml::node& node);

} // namespace ehdjet
