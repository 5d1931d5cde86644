#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ehdjet {

/// The text of a scene, table by table, every key with a comment that says where it comes from.
class SceneLines {
public:
  void table(std::string_view name);
  void key(std::string_view key, const std::string& value, const std::string& origin);
  void comment(std::string_view text);

  [[nodiscard]] std::string text() const;
  /// "table.key" and its comment.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& origins() const {
    return origins_;
  }

private:
  struct Line {
    std::string code, comment;
  };
  std::vector<Line> lines_;
  std::string table_;
  std::vector<std::pair<std::string, std::string>> origins_;
};

} // namespace ehdjet
