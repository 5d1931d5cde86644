#include "scene_lines.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace ehdjet {

void SceneLines::table(std::string_view name) {
  table_ = name;
  lines_.push_back({});
  lines_.push_back({fmt::format("[{}]", name), {}});
}

void SceneLines::key(std::string_view key, const std::string& value,
                     const std::string& origin) {
  lines_.push_back({fmt::format("{} = {}", key, value), origin});
  origins_.emplace_back(
      table_.empty() ? std::string(key) : fmt::format("{}.{}", table_, key), origin);
}

void SceneLines::comment(std::string_view text) {
  lines_.push_back({{}, std::string(text)});
}

std::string SceneLines::text() const {
  std::size_t widest = 0;
  for (const Line& l : lines_)
    if (!l.comment.empty()) widest = std::max(widest, l.code.size());
  std::string text;
  for (const Line& l : lines_)
    if (l.comment.empty())
      fmt::format_to(std::back_inserter(text), "{}\n", l.code);
    else if (l.code.empty())
      fmt::format_to(std::back_inserter(text), "# {}\n", l.comment);
    else
      fmt::format_to(std::back_inserter(text), "{:<{}}  # {}\n", l.code, widest, l.comment);
  return text;
}

} // namespace ehdjet
