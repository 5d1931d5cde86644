#include "suggestion.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace ehdjet {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1); // distances of a[0..i) to every b[0..j)
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replace, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

namespace {

/// Keys that have another name now.
constexpr std::array<std::pair<std::string_view, std::string_view>, 1> renamed{
    {{"coulomb.tolerance_norm", "coulomb.norm"}}};

} // namespace

std::string suggestion(std::string_view wrong, const std::vector<std::string>& known) {
  for (const auto& [before, now] : renamed)
    if (wrong == before) return fmt::format(" (did you mean {}?)", now);
  const auto table = [](std::string_view path) {
    const auto dot = path.find('.');
    return dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
  };
  const auto key = [](std::string_view path) { return path.substr(path.find('.') + 1); };

  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(2, key(wrong).size() / 3) + 1;
  for (const auto& k : known) {
    const std::size_t distance =
        edit_distance(key(wrong), key(k)) + (table(wrong) == table(k) ? 0 : 1);
    if (distance < least) least = distance, nearest = &k;
  }
  return nearest == nullptr ? "" : fmt::format(" (did you mean {}?)", *nearest);
}

} // namespace ehdjet
