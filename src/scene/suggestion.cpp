#include "suggestion.hpp"

#include "ehdjet/core/edit_distance.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {
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
