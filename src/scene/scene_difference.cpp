#include "ehdjet/scene/read_scene.hpp"

#include <fmt/format.h>
#include <map>

#include "scene_text.hpp"

namespace ehdjet {
namespace {

/// Every "table.key" that a run's jet depends on, with its value; and "[table]".
std::map<std::string, std::string> values_of(const std::string& resolved) {
  std::map<std::string, std::string> values;
  const SceneText text(resolved, "scene/resolved", {});
  for (const auto& [name, node] : text.root()) {
    const std::string table(name.str());
    if (table == "output") continue;
    if (!node.is_table()) {
      values[table] = value_text(node);
      continue;
    }
    values['[' + table + ']'] = "there";
    for (const auto& [key, value] : *node.as_table())
      values[table + '.' + std::string(key.str())] = value_text(value);
  }
  values.erase("run.end_time");
  return values;
}

} // namespace

std::optional<std::string> difference_from(const std::string& resolved,
                                           const SceneConfig& config) {
  const auto before = values_of(resolved), now = values_of(resolved_toml(config));
  const auto text_of = [](const auto& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("absent") : found->second;
  };
  auto all = before;
  all.insert(now.begin(), now.end());
  for (const auto& [key, either] : all) {
    const std::string was = text_of(before, key), is = text_of(now, key);
    if (was != is) return fmt::format("{} was {}, now it is {}", key, was, is);
  }
  return std::nullopt;
}

} // namespace ehdjet
