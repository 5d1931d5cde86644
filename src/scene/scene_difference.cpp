#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/recorded_scene.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "scene_text.hpp"

namespace ehdjet {
namespace {

/// Every "table.key" with its value; and "[table]".
std::map<std::string, std::string> values_of(const std::string& resolved) {
  std::map<std::string, std::string> values;
  for (auto& [path, value] : resolved_values(resolved)) {
    const std::string table = path.substr(0, path.find('.'));
    if (table != path) values['[' + table + ']'] = "there";
    values[path] = std::move(value);
  }
  return values;
}

/// Neither the jet nor what is written depends on these, up to the end.
bool is_free(const std::string& key) {
  constexpr std::array free{"run.end_time", "run.max_wall_time", "output.flush",
                            "output.checkpoints", "output.checkpoint_wall_time"};
  return std::ranges::find(free, key) != free.end();
}

/// The jet depends on the others.
bool is_decisive(const std::string& key) {
  return !key.starts_with("output.") && key != "[output]" && !is_free(key);
}

std::map<std::string, std::string> decisive_values(const std::string& resolved) {
  auto values = values_of(resolved);
  std::erase_if(values, [](const auto& value) { return !is_decisive(value.first); });
  return values;
}

std::vector<std::string> differences(const std::string& resolved, const SceneConfig& config,
                                     bool (*counts)(const std::string& key)) {
  const auto before = values_of(resolved), now = values_of(resolved_toml(config));
  const auto text_of = [](const auto& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("absent") : found->second;
  };
  auto all = before;
  all.insert(now.begin(), now.end());
  std::vector<std::string> found;
  for (const auto& [key, either] : all) {
    const std::string was = text_of(before, key), is = text_of(now, key);
    if (was != is && counts(key))
      found.push_back(fmt::format("{} was {}, now it is {}", key, was, is));
  }
  return found;
}

} // namespace

std::map<std::string, std::string> resolved_values(const std::string& resolved) {
  std::map<std::string, std::string> values;
  const SceneText text(resolved, "scene/resolved", {});
  for (const auto& [name, node] : text.root()) {
    const std::string table(name.str());
    if (!node.is_table()) {
      values[table] = value_text(node);
      continue;
    }
    for (const auto& [key, value] : *node.as_table())
      values[table + '.' + std::string(key.str())] = value_text(value);
  }
  return values;
}

std::optional<std::string> difference_from(const std::string& resolved,
                                           const SceneConfig& config) {
  const auto found = differences(resolved, config, is_decisive);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

std::vector<std::string> differences_in_file(const std::string& resolved,
                                             const SceneConfig& config) {
  return differences(resolved, config,
                     [](const std::string& key) { return !is_free(key); });
}

std::string title_of(const std::string& resolved) {
  const SceneText text(resolved, "scene/resolved", {});
  const toml::node* title = text.find("title");
  return title != nullptr ? title->value_or(std::string()) : std::string();
}

bool has_nozzle(const std::string& resolved) {
  return SceneText(resolved, "scene/resolved", {}).find("nozzle") != nullptr;
}

std::vector<std::string> distinctions(const std::vector<std::string>& resolved) {
  std::vector<std::map<std::string, std::string>> scenes;
  std::map<std::string, std::string> all;
  for (const std::string& text : resolved) {
    scenes.push_back(decisive_values(text));
    all.insert(scenes.back().begin(), scenes.back().end());
  }
  std::vector<std::string> distinct(scenes.size());
  for (const auto& entry : all) {
    const auto &key = entry.first, &value = entry.second; // which lambdas can capture
    if (key == "title" || key[0] == '[') continue;
    const auto differs = [&](const auto& scene) {
      const auto found = scene.find(key);
      return found == scene.end() || found->second != value;
    };
    if (std::ranges::none_of(scenes, differs)) continue;
    for (std::size_t k = 0; k < scenes.size(); ++k)
      if (const auto found = scenes[k].find(key); found != scenes[k].end())
        distinct[k] +=
            fmt::format("{}{} = {}", distinct[k].empty() ? "" : ", ", key, found->second);
  }
  return distinct;
}

} // namespace ehdjet
