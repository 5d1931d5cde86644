#include "ehdjet/scene/read_scene.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/text_file.hpp"
#include "ehdjet/scene/air_profile_file.hpp"
#include "ehdjet/scene/calibration_file.hpp"
#include "ehdjet/scene/chain_file.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <type_traits>

#include "cross_checks.hpp"
#include "scene_text.hpp"
#include "suggestion.hpp"

namespace ehdjet {
namespace {

/// Schema visitor: lists every "[table]" and every "table.key".
struct Names {
  std::string prefix;
  std::vector<std::string> tables, keys;

  template <class T, class Allowed>
  void required(std::string_view name, T&, const Allowed&, std::string_view) {
    keys.push_back(prefix + std::string(name));
  }
  template <class T, class Allowed>
  void optional(std::string_view name, T& v, const Allowed& a, std::string_view meaning,
                std::string_view = {}) {
    required(name, v, a, meaning);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) {
    table(name, config.emplace(), meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view) {
    tables.push_back('[' + std::string(name) + ']');
    prefix = std::string(name) + '.';
    describe(*this, config);
    prefix.clear();
  }
};

void refuse_unknown_names(const SceneText& text) {
  Names known;
  SceneConfig any;
  describe(known, any);
  const auto contains = [](const auto& list, const std::string& s) {
    return std::ranges::find(list, s) != list.end();
  };
  const auto refuse = [&](const std::string& path) {
    text.fail(path, fmt::format("unknown key {}{}", path, suggestion(path, known.keys)));
  };
  for (const auto& [name, node] : text.root()) {
    const std::string table(name.str());
    if (contains(known.keys, table)) continue;
    const std::string header = '[' + table + ']';
    if (!contains(known.tables, header)) {
      if (!node.is_table()) refuse(table);
      text.fail(table, fmt::format("unknown table {}{}", header,
                                   suggestion(header, known.tables)));
    }
    if (!node.is_table())
      text.fail(table, fmt::format("{} = {}: must be a table {}", table, value_text(node),
                                   header));
    for (const auto& entry : *node.as_table())
      if (const std::string path = table + '.' + std::string(entry.first.str());
          !contains(known.keys, path))
        refuse(path);
  }
}

// One overload per kind of allowed values: true and `value` set if the node is acceptable.
bool convert(const toml::node& node, const Range& range, double& value) {
  const auto number = node.value<double>(); // an integer is a number, too
  if (!node.is_number() || !number || !range.contains(*number)) return false;
  value = *number;
  return true;
}
bool convert(const toml::node& node, const Range& range, std::size_t& value) {
  const auto* number = node.as_integer();
  if (number == nullptr || !range.contains(static_cast<double>(number->get())))
    return false;
  value = static_cast<std::size_t>(number->get());
  return true;
}
bool convert(const toml::node& node, const Triple& triple, std::array<double, 3>& value) {
  const auto* list = node.as_array();
  if (list == nullptr || list->size() != value.size()) return false;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!convert(*list->get(i), triple.each, value[i])) return false;
  return true;
}
bool convert(const toml::node& node, const Words& words, std::string& value) {
  const auto* text = node.as_string();
  if (text == nullptr || std::ranges::find(words.names, text->get()) == words.names.end())
    return false;
  value = text->get();
  return true;
}
bool convert(const toml::node& node, const ModeList& allowed,
             std::vector<RelaxationMode>& modes) {
  const auto* list = node.as_array();
  if (list == nullptr || list->empty() || list->size() > allowed.most) return false;
  for (const toml::node& entry : *list) {
    const auto* pair = entry.as_array();
    RelaxationMode& mode = modes.emplace_back();
    if (pair == nullptr || pair->size() != 2
        || !convert(*pair->get(0), allowed.modulus, mode.modulus)
        || !convert(*pair->get(1), allowed.relaxation_time, mode.relaxation_time))
      return false;
  }
  return true;
}
bool convert(const toml::node& node, AnyText, std::string& value) {
  if (const auto* text = node.as_string()) value = text->get();
  return node.is_string();
}
bool convert(const toml::node& node, YesNo, bool& value) {
  if (const auto* flag = node.as_boolean()) value = flag->get();
  return node.is_boolean();
}
template <class Enum, std::size_t N>
bool convert(const toml::node& node, const Choices<Enum, N>& choices, Enum& value) {
  const auto* text = node.as_string();
  if (text == nullptr) return false;
  for (const auto& c : choices)
    if (c.name == text->get()) value = c.value;
  return name_of(value, choices) == text->get();
}
template <class T, class Allowed>
bool convert(const toml::node& node, const Allowed& allowed, std::optional<T>& value) {
  return convert(node, allowed, value.emplace());
}

/// What a value must be; `node` is null if it is missing.
std::string requirement(const auto&, const auto& allowed, const toml::node*) {
  return allowed_text(allowed);
}
std::string requirement(const auto&, const Range& range, const toml::node* node) {
  return (node != nullptr && !node->is_number() ? "a number " : "") + range.text();
}
std::string requirement(const std::size_t&, const Range& range, const toml::node*) {
  return "a whole number " + range.text();
}
std::string requirement(const std::optional<std::size_t>&, const Range& range,
                        const toml::node*) {
  return requirement(std::size_t{}, range, nullptr);
}

std::string shown(const toml::node& node, const Range& range) {
  const bool has_unit = node.is_number() && range.unit != "-";
  return value_text(node) + (has_unit ? fmt::format(" {}", range.unit) : "");
}
std::string shown(const toml::node& node, const auto&) {
  return value_text(node);
}

std::string hint(const toml::node& node, const Range& range) {
  if (!node.is_number() || range.unit == "-") return "";
  const double value = *node.value<double>();
  const bool other_units =
      value > range.highest || (range.lowest > 0 && value < range.lowest);
  return other_units ? ", in SI units" : "";
}
std::string hint(const toml::node&, const auto&) {
  return "";
}

/// Schema visitor: fills a configuration from TOML.
class Reader {
public:
  explicit Reader(const SceneText& text, std::string prefix = "")
      : text_(text)
      , prefix_(std::move(prefix)) {}

  template <class T, class Allowed>
  void required(std::string_view name, T& value, const Allowed& allowed,
                std::string_view meaning) const {
    if (!read(name, value, allowed, meaning))
      text_.fail(prefix_ + std::string(name),
                 fmt::format("{}{} is missing: must be {} ({})", prefix_, name,
                             requirement(value, allowed, nullptr), meaning));
  }
  template <class T, class Allowed>
  void optional(std::string_view name, T& value, const Allowed& allowed,
                std::string_view meaning, std::string_view = {}) const {
    read(name, value, allowed, meaning);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) const {
    if (text_.find(name) != nullptr) table(name, config.emplace(), meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view) const {
    Reader inner(text_, std::string(name) + '.');
    describe(inner, config);
  }

private:
  template <class T, class Allowed>
  bool read(std::string_view name, T& value, const Allowed& allowed,
            std::string_view meaning) const {
    const std::string path = prefix_ + std::string(name);
    const toml::node* node = text_.find(path);
    if (node == nullptr) return false;
    if (!convert(*node, allowed, value))
      text_.fail(path, fmt::format("{} = {}: must be {}{} ({})", path,
                                   shown(*node, allowed), requirement(value, allowed, node),
                                   hint(*node, allowed), meaning));
    return true;
  }

  const SceneText& text_;
  std::string prefix_;
};

} // namespace

Scene read_scene_text(const std::string& text, const std::string& name,
                      const std::filesystem::path& folder, const Overrides& overrides) {
  const SceneText source(text, name, overrides);
  refuse_unknown_names(source);
  Scene scene;
  scene.given = text;
  Reader reader(source);
  describe(reader, scene.config);
  settle(scene.config, source);
  if (scene.config.coulomb && scene.config.coulomb->calibration)
    scene.costs = read_calibration(folder / *scene.config.coulomb->calibration);
  if (scene.config.air && scene.config.air->profile)
    scene.air_profile = read_air_profile(folder / *scene.config.air->profile);
  if (scene.config.chain) {
    const ChainConfig& chain = *scene.config.chain;
    scene.chain = read_chain(folder / chain.file, chain.time);
    check_chain_fits(scene, source);
  }
  check_stability(scene, source);
  return scene;
}

SceneConfig config_of(const std::string& resolved) {
  const SceneText source(resolved, "scene/resolved", {});
  SceneConfig config;
  Reader reader(source);
  describe(reader, config);
  return config;
}

Scene read_scene(const std::filesystem::path& file, const Overrides& overrides) {
  const std::string text = read_text_file(file, "the scene file");
  return read_scene_text(text, file.string(), file.parent_path(), overrides);
}

} // namespace ehdjet
