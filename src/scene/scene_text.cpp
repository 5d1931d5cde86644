#include "scene_text.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace ehdjet {
namespace {

/// "nozzle.radius" -> {"nozzle", "radius"}; "title" -> {"", "title"}.
std::pair<std::string_view, std::string_view> split(std::string_view path) {
  const auto dot = path.find('.');
  if (dot == std::string_view::npos) return {{}, path};
  return {path.substr(0, dot), path.substr(dot + 1)};
}

std::string trimmed(const std::string& text) {
  constexpr const char* blank = " \t";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) + 1 - first);
}

bool is_bare_word(std::string_view text) {
  return !text.empty() && std::ranges::none_of(text, [](char c) {
    return static_cast<unsigned char>(c) < 0x20
           || std::string_view("\"'[]{}=#,").find(c) != std::string_view::npos;
  });
}

/// One TOML value, as a table with the single key "value".
std::optional<toml::table> parse_value(const std::string& text) {
  try {
    toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) { // not TOML: perhaps a bare word
  }
  if (!is_bare_word(text)) return std::nullopt;
  return toml::table{{"value", text}};
}

/// Numbers, or lists of numbers; more would make a message long.
bool is_short(const toml::array& list) {
  constexpr std::size_t few = 16;
  return list.size() <= few && std::ranges::all_of(list, [](const toml::node& entry) {
           return entry.is_number() || (entry.is_array() && is_short(*entry.as_array()));
         });
}

} // namespace

SceneText::SceneText(const std::string& text, const std::string& name,
                     const Overrides& overrides)
    : name_(name) {
  try {
    root_ = toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}:{}: {}", name, e.source().begin.line,
                                 e.source().begin.column, e.description()));
  }
  for (const Override& o : overrides) override_with(o);
}

void SceneText::override_with(const Override& override) {
  const std::string& assignment = override.assignment;
  const auto refuse = [&](std::string_view why) {
    throw InputError(fmt::format("{}: {}", override.origin, why));
  };
  const auto equals = assignment.find('=');
  if (equals == std::string::npos)
    refuse("expected table.key=value, for example nozzle.radius=5e-5");
  const std::string path = trimmed(assignment.substr(0, equals));
  const std::string value = trimmed(assignment.substr(equals + 1));
  const auto [table_name, key] = split(path);
  if (key.empty() || (table_name.empty() && key.size() != path.size()))
    refuse("expected table.key=value, for example nozzle.radius=5e-5");

  toml::table* table = &root_;
  if (!table_name.empty()) {
    if (!root_.contains(table_name)) root_.insert(table_name, toml::table{});
    table = root_.get(table_name)->as_table();
    if (table == nullptr) refuse(fmt::format("{} is not a table", table_name));
  }
  if (value.empty()) {
    table->erase(key);
    return;
  }
  const auto parsed = parse_value(value);
  if (!parsed) refuse(fmt::format("`{}` is not a TOML value", value));
  parsed->get("value")->visit(
      [table, name = key](const auto& node) { table->insert_or_assign(name, node); });
  overridden_[path] = override.origin;
}

const toml::node* SceneText::find(std::string_view path) const {
  const auto [table_name, key] = split(path);
  if (table_name.empty()) return root_.get(key);
  const toml::node* table = root_.get(table_name);
  return table != nullptr && table->is_table() ? table->as_table()->get(key) : nullptr;
}

std::string SceneText::where(std::string_view path) const {
  const auto [table_name, key] = split(path);
  for (const std::string_view at : {path, table_name})
    if (const auto set = overridden_.find(at); set != overridden_.end()) return set->second;
  for (const toml::node* node :
       {find(path), table_name.empty() ? nullptr : root_.get(table_name)})
    if (node != nullptr && node->source().begin)
      return fmt::format("{}:{}", name_, node->source().begin.line);
  // A table that only an override made.
  const auto made = std::ranges::find_if(overridden_, [&](const auto& entry) {
    return !path.empty() && entry.first.starts_with(std::string(path) + '.');
  });
  return made == overridden_.end() ? name_ : made->second;
}

void SceneText::fail(std::string_view path, std::string_view message) const {
  throw InputError(fmt::format("{}: {}", where(path), message));
}

std::string value_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return toml_text(number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* text = node.as_string()) return toml_text(std::string_view(text->get()));
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* list = node.as_array(); list != nullptr && is_short(*list)) {
    std::string text = "[";
    for (const toml::node& entry : *list)
      text += (text.size() > 1 ? ", " : "") + value_text(entry);
    return text + ']';
  }
  return node.is_table() ? "a table" : node.is_array() ? "an array" : "a date or time";
}

} // namespace ehdjet
