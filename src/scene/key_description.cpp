#include "key_description.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/schema.hpp"

#include <fmt/format.h>
#include <optional>

namespace ehdjet {
namespace {

/// Schema visitor: finds one key.
struct Lookup {
  std::string_view path;
  std::string prefix, found, unit;

  template <class T, class Allowed>
  void required(std::string_view name, T&, const Allowed& allowed,
                std::string_view meaning) {
    if (prefix + std::string(name) != path) return;
    found = fmt::format("must be {} ({})", allowed_text(allowed), meaning);
    unit = unit_text(allowed);
  }
  template <class T, class Allowed>
  void optional(std::string_view name, T& value, const Allowed& allowed,
                std::string_view meaning, std::string_view = {}) {
    required(name, value, allowed, meaning);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) {
    table(name, config.emplace(), meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view) {
    prefix = std::string(name) + '.';
    describe(*this, config);
    prefix.clear();
  }
};

Lookup look_up(std::string_view path) {
  Lookup lookup{.path = path, .prefix = {}, .found = {}, .unit = {}};
  SceneConfig any;
  describe(lookup, any);
  return lookup;
}

} // namespace

std::string key_unit(std::string_view path) {
  const std::string unit = look_up(path).unit;
  return unit == "-" ? "" : unit;
}

std::string key_description(std::string_view path) {
  Lookup lookup = look_up(path);
  EHDJET_EXPECTS(!lookup.found.empty());
  return lookup.found;
}

} // namespace ehdjet
