#include "sweep_plan.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <toml++/toml.h>
#include <utility>

namespace ehdjet {
namespace {

constexpr std::size_t most_levels = 100'000, most_repeats = 1000;

/// A value in TOML syntax; none of a table, or of a date or time.
std::optional<std::string> toml_value(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return toml_text(number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* text = node.as_string()) return toml_text(std::string_view(text->get()));
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (!node.is_array()) return std::nullopt;
  std::string list;
  for (const toml::node& entry : *node.as_array()) {
    const auto text = toml_value(entry);
    if (!text) return std::nullopt;
    list += (list.empty() ? "" : ", ") + *text;
  }
  return '[' + list + ']';
}

/// A value as a part of a file's name: [0, -1, 0] is 0_-1_0.
std::string name_part(std::string_view value) {
  std::string part;
  for (const char c : value) {
    const bool kept = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z')
                      || (c >= 'A' && c <= 'Z') || c == '.' || c == '+' || c == '-'
                      || c == '_';
    if (kept)
      part += c;
    else if (c == ',')
      part += '_';
    else if (c != '[' && c != ']' && c != ' ' && c != '"')
      part += '-';
  }
  return part;
}

/// A key of the plan's tables with its list or range.
struct Entry {
  std::string path;
  const toml::node* node;
};

/// The value of a key at one level.
struct Value {
  std::string text;
  const toml::node* node; ///< which says the line
};

std::pair<toml::source_index, toml::source_index> position(const Entry& entry) {
  const toml::source_position begin = entry.node->source().begin;
  return {begin.line, begin.column};
}

/// Names levels after their values: viscosity-2, with the table where two tables have such a key.
void name_levels(std::vector<SweepFactor>& factors) {
  const auto short_name = [](const std::string& path) {
    return path.substr(path.find('.') + 1);
  };
  std::map<std::string, int> users;
  for (const SweepFactor& factor : factors)
    for (const std::string& key : factor.keys) ++users[short_name(key)];
  for (SweepFactor& factor : factors)
    for (SweepFactor::Level& level : factor.levels) {
      if (!level.name.empty()) continue;
      for (std::size_t k = 0; k < factor.keys.size(); ++k) {
        const std::string& key = factor.keys[k];
        const std::string value = level.overrides[k].assignment.substr(key.size() + 1);
        level.name += fmt::format("{}{}-{}", k == 0 ? "" : "_",
                                  users[short_name(key)] > 1 ? key : short_name(key),
                                  name_part(value));
      }
    }
}

class PlanReader {
public:
  explicit PlanReader(const std::filesystem::path& file);
  SweepPlan read();

private:
  [[nodiscard]] std::string where(const toml::node& node) const {
    return fmt::format("{}:{}", name_, node.source().begin.line);
  }
  [[noreturn]] void refuse(const toml::node& node, std::string_view why) const {
    throw InputError(fmt::format("{}: {}", where(node), why));
  }
  [[nodiscard]] std::string text(std::string_view key) const;
  [[nodiscard]] std::size_t count(const toml::node& node, std::string_view key,
                                  std::size_t least, std::size_t most) const;
  [[nodiscard]] const toml::table& table(const toml::node& node,
                                         std::string_view name) const;
  [[nodiscard]] std::vector<Entry> entries(const toml::table& table,
                                           std::string_view besides = {}) const;
  [[nodiscard]] std::vector<Value> values(const Entry& entry) const;
  [[nodiscard]] std::vector<Value> range(const Entry& entry) const;
  [[nodiscard]] SweepFactor factor(const std::vector<Entry>& keys,
                                   const toml::node* labels) const;
  [[nodiscard]] std::vector<std::string> labels_of(const toml::node& node) const;
  [[nodiscard]] Override override_of(const std::string& path, const Value& value) const {
    return {path + '=' + value.text, where(*value.node)};
  }
  void add_factors(SweepPlan& plan) const;
  void refuse_equal_values(const Entry& entry) const;
  void refuse_keys_that_stand_twice() const;

  std::filesystem::path file_;
  std::string name_;
  toml::table root_;
};

PlanReader::PlanReader(const std::filesystem::path& file)
    : file_(file)
    , name_(file.string()) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InputError(fmt::format("cannot read the plan {}: {}", name_,
                                 in ? "it is a folder" : std::strerror(errno)));
  try {
    root_ = toml::parse(std::string{std::istreambuf_iterator<char>(in), {}}, name_);
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, e.source().begin.line,
                                 e.source().begin.column, e.description()));
  }
}

/// A text of the top level; empty if it is not there.
std::string PlanReader::text(std::string_view key) const {
  const toml::node* node = root_.get(key);
  if (node == nullptr) return {};
  const auto* text = node->as_string();
  if (text == nullptr || text->get().empty())
    refuse(*node, fmt::format("{}: must be text in quotes", key));
  return text->get();
}

std::size_t PlanReader::count(const toml::node& node, std::string_view key,
                              std::size_t least, std::size_t most) const {
  const auto* number = node.as_integer();
  if (number == nullptr || number->get() < static_cast<std::int64_t>(least)
      || number->get() > static_cast<std::int64_t>(most))
    refuse(node, fmt::format("{} = {}: must be a whole number from {} to {}", key,
                             toml_value(node).value_or("a table"), least, most));
  return static_cast<std::size_t>(number->get());
}

const toml::table& PlanReader::table(const toml::node& node, std::string_view name) const {
  if (!node.is_table()) refuse(node, fmt::format("{}: must be a table", name));
  return *node.as_table();
}

/// Every "table.key" of a table of the plan, in the order of the file, besides one that is no key of a
/// scene.
std::vector<Entry> PlanReader::entries(const toml::table& table,
                                       std::string_view besides) const {
  std::vector<Entry> found;
  const auto add = [&](std::string path, const toml::node& node) {
    found.push_back({std::move(path), &node});
  };
  for (const auto& [name, node] : table) {
    const std::string path(name.str());
    if (path == besides) continue;
    const bool whole = path == "title" || path.find('.') != std::string::npos;
    if (!whole && !node.is_table())
      refuse(node,
             fmt::format("{}: expected a key of a scene, such as nozzle.radius", path));
    if (whole)
      add(path, node);
    else
      for (const auto& [key, value] : *node.as_table())
        add(path + '.' + std::string(key.str()), value);
  }
  std::ranges::sort(found, {}, position);
  return found;
}

/// The values of { from = 1, to = 100, count = 5, spacing = "log" }. They are rounded to twelve digits, so
/// that a tenth is 0.1.
std::vector<Value> PlanReader::range(const Entry& entry) const {
  const toml::table& table = *entry.node->as_table();
  for (const auto& [key, node] : table)
    if (constexpr std::array<std::string_view, 4> known{"from", "to", "count", "spacing"};
        std::ranges::find(known, key.str()) == known.end())
      refuse(node, fmt::format("{}: unknown key {} of a range (known: from, to, count, "
                               "spacing)",
                               entry.path, key.str()));
  const auto end = [&](std::string_view key) {
    const toml::node* node = table.get(key);
    if (node == nullptr || !node->is_number() || !std::isfinite(*node->value<double>()))
      refuse(*entry.node, fmt::format("{}: a range needs `{}`, a number", entry.path, key));
    return *node->value<double>();
  };
  const double from = end("from"), to = end("to");
  const toml::node* number = table.get("count");
  if (number == nullptr)
    refuse(*entry.node,
           fmt::format("{}: a range needs `count`, a number of values", entry.path));
  const std::size_t n = count(*number, entry.path + ": count", 2, most_levels);
  const std::string spacing = table["spacing"].value_or(std::string("linear"));
  if ((table.contains("spacing") && !table["spacing"].is_string())
      || (spacing != "linear" && spacing != "log"))
    refuse(*table.get("spacing"),
           fmt::format("{}: spacing must be \"linear\" or \"log\"", entry.path));
  const bool log = spacing == "log";
  if (from == to || (log && !(from * to > 0)))
    refuse(*entry.node,
           fmt::format("{}: from = {}, to = {}: must be different{}", entry.path, from, to,
                       log ? " numbers of the same sign, not 0, with log spacing" : ""));
  std::vector<Value> values;
  for (std::size_t i = 0; i < n; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(n - 1);
    const double value = i == 0       ? from
                         : i + 1 == n ? to
                         : log        ? from * std::pow(to / from, part)
                                      : from + (to - from) * part;
    values.push_back({toml_text(std::stod(fmt::format("{:.12g}", value))), entry.node});
  }
  return values;
}

/// The values of a list or a range.
std::vector<Value> PlanReader::values(const Entry& entry) const {
  if (entry.node->is_table()) return range(entry);
  const auto* list = entry.node->as_array();
  if (list == nullptr || list->empty() || list->size() > most_levels)
    refuse(*entry.node,
           fmt::format("{}: must be a list of values, or a range such as {{ from = 1, to = "
                       "100, count = 5, spacing = \"log\" }}. A value for all runs belongs "
                       "into [set]",
                       entry.path));
  std::vector<Value> values;
  for (const toml::node& node : *list) {
    const auto text = toml_value(node);
    if (!text)
      refuse(node,
             fmt::format("{}: a value must be a number, a text, true, false or a list",
                         entry.path));
    values.push_back({*text, &node});
  }
  return values;
}

std::vector<std::string> PlanReader::labels_of(const toml::node& node) const {
  const auto* list = node.as_array();
  std::vector<std::string> labels;
  if (list != nullptr)
    for (const toml::node& entry : *list) {
      const auto* text = entry.as_string();
      if (text == nullptr || text->get().empty() || name_part(text->get()) != text->get()
          || std::ranges::find(labels, text->get()) != labels.end())
        refuse(entry, "label: must be different texts of letters, digits, . + - and _");
      labels.push_back(text->get());
    }
  return labels;
}

/// A factor of one or several keys, whose levels have no names yet unless there are labels.
SweepFactor PlanReader::factor(const std::vector<Entry>& keys,
                               const toml::node* labels) const {
  SweepFactor factor;
  for (const Entry& entry : keys) {
    const std::vector<Value> list = values(entry);
    if (factor.keys.empty()) factor.levels.resize(list.size());
    if (list.size() != factor.levels.size())
      refuse(*entry.node,
             fmt::format("{} has {} values, but {} has {}: lists that go together must be "
                         "equally long",
                         entry.path, list.size(), factor.keys.front(),
                         factor.levels.size()));
    factor.keys.push_back(entry.path);
    for (std::size_t i = 0; i < list.size(); ++i)
      factor.levels[i].overrides.push_back(override_of(entry.path, list[i]));
  }
  if (labels == nullptr) return factor;
  const std::vector<std::string> names = labels_of(*labels);
  if (names.size() != factor.levels.size())
    refuse(*labels, fmt::format("label: must be a list of {} texts, one per value of {}",
                                factor.levels.size(), factor.keys.front()));
  for (std::size_t i = 0; i < names.size(); ++i) factor.levels[i].name = names[i];
  return factor;
}

void PlanReader::refuse_equal_values(const Entry& entry) const {
  std::set<std::string> seen;
  for (const Value& value : values(entry))
    if (!seen.insert(value.text).second)
      refuse(*value.node,
             fmt::format("{} = {}: stands twice in the list", entry.path, value.text));
}

void PlanReader::add_factors(SweepPlan& plan) const {
  std::vector<std::pair<decltype(position({})), SweepFactor>> factors;
  if (const toml::node* grid = root_.get("grid"))
    for (const Entry& entry : entries(table(*grid, "[grid]"))) {
      refuse_equal_values(entry);
      factors.emplace_back(position(entry), factor({entry}, nullptr));
    }
  if (const toml::node* all = root_.get("together")) {
    const auto* tables = all->as_array();
    if (tables == nullptr) refuse(*all, "together: must be tables [[together]]");
    for (const toml::node& node : *tables) {
      const toml::table& lists = table(node, "[[together]]");
      const std::vector<Entry> keys = entries(lists, "label");
      if (keys.empty()) refuse(node, "[[together]]: has no key of a scene");
      factors.emplace_back(position(keys.front()), factor(keys, lists.get("label")));
    }
  }
  std::ranges::sort(factors, {}, [](const auto& f) { return f.first; });
  for (auto& [at, factor] : factors) plan.factors.push_back(std::move(factor));
}

/// A key of a run must come from one place of the plan.
void PlanReader::refuse_keys_that_stand_twice() const {
  std::map<std::string, const toml::node*> seen;
  const auto look_at = [&](const toml::node& node, std::string_view besides) {
    for (const Entry& entry : entries(*node.as_table(), besides))
      if (const auto [at, is_new] = seen.emplace(entry.path, entry.node); !is_new)
        refuse(*entry.node,
               fmt::format("{} is given in {} already", entry.path, where(*at->second)));
  };
  for (const char* name : {"set", "grid"})
    if (const toml::node* node = root_.get(name)) look_at(*node, {});
  if (const toml::node* all = root_.get("together"))
    for (const toml::node& node : *all->as_array()) look_at(node, "label");
}

SweepPlan PlanReader::read() {
  for (const auto& [key, node] : root_)
    if (constexpr std::array<std::string_view, 6> known{"scene", "name", "repeats", "set",
                                                        "grid", "together"};
        std::ranges::find(known, key.str()) == known.end())
      refuse(node,
             fmt::format("unknown key {} of a plan (known: scene, name, repeats, [set], "
                         "[grid], [[together]])",
                         key.str()));
  SweepPlan plan;
  const std::string scene = text("scene");
  if (scene.empty())
    throw InputError(fmt::format("{}: scene is missing: must be the scene file (TOML) that "
                                 "all runs start from, relative to the plan",
                                 name_));
  plan.scene = (file_.parent_path() / scene).lexically_normal();
  plan.name = text("name");
  if (plan.name.empty()) plan.name = plan.scene.stem().string();
  if (const toml::node* name = root_.get("name"); name_part(plan.name) != plan.name) {
    if (name != nullptr)
      refuse(*name,
             fmt::format("name = \"{}\": must have only letters, digits, . + - and _",
                         plan.name));
    plan.name = name_part(plan.name);
  }
  if (const toml::node* repeats = root_.get("repeats"))
    plan.repeats = count(*repeats, "repeats", 1, most_repeats);
  if (const toml::node* set = root_.get("set"))
    for (const Entry& entry : entries(table(*set, "[set]"))) {
      const auto value = toml_value(*entry.node);
      if (!value)
        refuse(*entry.node,
               fmt::format("{}: a value must be a number, a text, true, false or a list",
                           entry.path));
      plan.settings.push_back(override_of(entry.path, {*value, entry.node}));
    }
  add_factors(plan);
  if (plan.factors.empty())
    throw InputError(
        fmt::format("{}: varies no key: [grid] or [[together]] is missing", name_));
  refuse_keys_that_stand_twice();
  name_levels(plan.factors);
  return plan;
}

} // namespace

SweepPlan read_plan(const std::filesystem::path& file) {
  return PlanReader(file).read();
}

} // namespace ehdjet
